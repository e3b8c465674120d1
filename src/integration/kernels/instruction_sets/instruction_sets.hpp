// Where each instruction set's kernels are. A file of this folder named after an instruction set is
// compiled for it, and none of its code may run before the processor was asked whether it has it.
#pragma once

#include "integration/kernels/chain_kernels.hpp"

namespace spring_pendulum {

extern const ChainKernels kBaselineKernels;
extern const ChainKernels kAvx2Kernels;
extern const ChainKernels kAvx512Kernels;

}  // namespace spring_pendulum
