# The linker may merge functions of the same name and choose the one that is compiled for a newer
# instruction set, which fails on an older processor. So these files must not define functions with
# external linkage.
# Usage: cmake -DNM=... -DOBJECTS=... -P kernel_symbols.cmake
set(checked 0)
foreach(object ${OBJECTS})
  if(object MATCHES "instruction_sets/avx[0-9]+\\.cpp")
    execute_process(COMMAND ${NM} -C --defined-only --extern-only ${object}
      OUTPUT_VARIABLE symbols RESULT_VARIABLE failed)
    if(failed OR NOT symbols MATCHES "kAvx[0-9]+Kernels")
      message(FATAL_ERROR "${object}: no table of kernels found in it")
    endif()
    if(symbols MATCHES "\n?[^\n]* [TWi] [^\n]*")
      message(FATAL_ERROR "${object}: defines ${CMAKE_MATCH_0}")
    endif()
    math(EXPR checked "${checked} + 1")
  endif()
endforeach()
if(checked EQUAL 0)
  message(FATAL_ERROR "no kernels found among ${OBJECTS}")
endif()
