# MPI is optional; where it is found, MPI_FOUND is true and MPI::MPI_CXX links it. Programs use its C
# interface: the C++ one, which MPI 3.0 removed, stays out of mpi.h.
set(MPI_CXX_SKIP_MPICXX ON)
if(NOT SPRING_PENDULUM_SANITIZE)  # MPI leaks and races by itself
  find_package(MPI QUIET COMPONENTS CXX)
endif()
