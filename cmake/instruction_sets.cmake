# The kernels are compiled once for every instruction set and picked when the program runs; all else
# is compiled for the baseline of the architecture.
set(kernel_folder src/integration/kernels/instruction_sets)
set(kernel_sources ${kernel_folder}/baseline.cpp)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  set(avx2_flags -mavx2 -mfma)
  list(APPEND kernel_sources ${kernel_folder}/avx2.cpp ${kernel_folder}/avx512.cpp)
  set_source_files_properties(${kernel_folder}/avx2.cpp PROPERTIES
    COMPILE_OPTIONS "${avx2_flags}")
  set_source_files_properties(${kernel_folder}/avx512.cpp PROPERTIES
    COMPILE_OPTIONS "-mfma;-mavx512f;-mavx512dq;-mavx512vl;-mprefer-vector-width=512")
  set_source_files_properties(src/integration/kernels/chain_kernels.cpp PROPERTIES
    COMPILE_DEFINITIONS SPRING_PENDULUM_X86_KERNELS)
endif()
# Functions begin at cache lines. Otherwise the time of the Taylor series of short chains varies by
# several per cent with whatever is linked before them.
set_property(SOURCE ${kernel_sources} APPEND PROPERTY COMPILE_OPTIONS -falign-functions=64)
if(SPRING_PENDULUM_SANITIZE MATCHES "address")
  # Compilers need over ten minutes for the unrolled kernels with this sanitizer.
  set_property(SOURCE ${kernel_sources} APPEND PROPERTY COMPILE_OPTIONS -fno-sanitize=all)
endif()
