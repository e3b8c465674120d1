# Where things go: catkin's folders in a catkin workspace, the usual ones without it.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
if(catkin_FOUND)
  set(install_lib ${CATKIN_PACKAGE_LIB_DESTINATION})
  set(install_bin ${CATKIN_PACKAGE_BIN_DESTINATION})
  set(install_share ${CATKIN_PACKAGE_SHARE_DESTINATION})
  set(install_python ${CATKIN_GLOBAL_PYTHON_DESTINATION})
else()
  set(install_lib ${CMAKE_INSTALL_LIBDIR})
  set(install_bin ${CMAKE_INSTALL_BINDIR})
  set(install_share ${CMAKE_INSTALL_DATADIR}/spring_pendulum)
  # Where Python on Debian looks: packages in /usr, all else in other prefixes.
  set(install_python lib/python${PYTHON_VERSION_MAJOR}.${PYTHON_VERSION_MINOR}/dist-packages)
  if(CMAKE_INSTALL_PREFIX STREQUAL /usr)
    set(install_python lib/python3/dist-packages)
  endif()
endif()

install(TARGETS spring_pendulum EXPORT spring_pendulumTargets
  LIBRARY DESTINATION ${install_lib} ARCHIVE DESTINATION ${install_lib})
install(TARGETS Exercise3 check_frames sweep RUNTIME DESTINATION ${install_bin})
install(PROGRAMS scripts/plot_table.py scripts/method_styles.py DESTINATION ${install_bin})
install(DIRECTORY include/spring_pendulum DESTINATION include)
install(DIRECTORY data config DESTINATION ${install_share})

# Completion for bash, and manual pages made from --help.
foreach(program Exercise3 check_frames sweep record_bag)
  if(NOT TARGET ${program})
    continue()
  endif()
  install(FILES scripts/completion.bash
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program})
  set(purpose "simulates a chain of particles and springs")
  if(program STREQUAL check_frames)
    set(purpose "names mistakes in programs that simulate a chain of particles and springs")
  elseif(program STREQUAL sweep)
    set(purpose "simulates many chains of particles and springs and writes a table")
  endif()
  find_program(HELP2MAN help2man)
  if(HELP2MAN AND NOT CMAKE_CROSSCOMPILING AND NOT SPRING_PENDULUM_SANITIZE)
    add_custom_command(OUTPUT ${program}.1
      COMMAND ${HELP2MAN} --locale=C.UTF-8 --no-info --version-string=${PROJECT_VERSION} --output=${program}.1
        --name "${purpose}" $<TARGET_FILE:${program}>
      DEPENDS ${program} VERBATIM)
    add_custom_target(${program}_manual ALL DEPENDS ${program}.1)
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${program}.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  endif()
endforeach()

# find_package(spring_pendulum) gives the target spring_pendulum::spring_pendulum. catkin writes the
# package's configuration itself and takes the targets in through cmake/spring_pendulum-extras.cmake.
install(EXPORT spring_pendulumTargets NAMESPACE spring_pendulum::
  DESTINATION ${install_share}/cmake)
export(EXPORT spring_pendulumTargets NAMESPACE spring_pendulum::
  FILE ${CMAKE_CURRENT_BINARY_DIR}/spring_pendulumTargets.cmake)
if(NOT catkin_FOUND)
  configure_package_config_file(cmake/spring_pendulumConfig.cmake.in spring_pendulumConfig.cmake
    INSTALL_DESTINATION ${install_share}/cmake)
  write_basic_package_version_file(spring_pendulumConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/spring_pendulumConfig.cmake
    ${CMAKE_CURRENT_BINARY_DIR}/spring_pendulumConfigVersion.cmake
    DESTINATION ${install_share}/cmake)
endif()
if(catkin_FOUND AND PROJECT_SOURCE_DIR STREQUAL CMAKE_SOURCE_DIR)
  configure_file(cmake/relocate.cmake.in relocate.cmake @ONLY)
  install(SCRIPT ${CMAKE_CURRENT_BINARY_DIR}/relocate.cmake)
endif()

# A Debian package of what needs no ROS (scripts/release.sh).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME spring-pendulum)
set(CPACK_PACKAGE_CONTACT "The spring_pendulum authors <maintainers@spring-pendulum.example>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "simulator for chains of particles and springs")
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_CURRENT_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3, python3-numpy")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "gnuplot-nox, python3-matplotlib, libeigen3-dev")
include(CPack)
