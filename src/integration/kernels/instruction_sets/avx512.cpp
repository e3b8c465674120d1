#include "integration/kernels/instruction_sets/all_kernels.hpp"

namespace spring_pendulum {

const ChainKernels kAvx512Kernels = kernelsNamed("avx512");

}  // namespace spring_pendulum
