#include "integration/kernels/instruction_sets/all_kernels.hpp"

namespace spring_pendulum {

const ChainKernels kAvx2Kernels = kernelsNamed("avx2");

}  // namespace spring_pendulum
