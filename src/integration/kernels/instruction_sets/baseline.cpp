#include "integration/kernels/instruction_sets/all_kernels.hpp"

namespace spring_pendulum {

const ChainKernels kBaselineKernels = kernelsNamed("baseline");

}  // namespace spring_pendulum
