// The kernels of each instruction set. Every file in this folder that is named after an instruction
// set is compiled for it. None of its code may run on a processor without that instruction set.
#pragma once

#include "integration/kernels/chain_kernels.hpp"

namespace spring_pendulum {

extern const ChainKernels kBaselineKernels;
extern const ChainKernels kAvx2Kernels;
extern const ChainKernels kAvx512Kernels;

}  // namespace spring_pendulum
