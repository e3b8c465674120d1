# Read by find_package(spring_pendulum) in a catkin workspace: the exported targets of the core,
# unless the package is built in the same workspace and has them already.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3)
if(NOT TARGET spring_pendulum::spring_pendulum)
@[if DEVELSPACE]@
  include("@(CMAKE_CURRENT_BINARY_DIR)/spring_pendulumTargets.cmake")
@[else]@
  include("${spring_pendulum_DIR}/spring_pendulumTargets.cmake")
@[end if]@
endif()
