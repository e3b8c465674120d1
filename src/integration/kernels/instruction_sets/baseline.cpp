#include "integration/kernels/instruction_sets/all_kernels.hpp"
#include "integration/kernels/instruction_sets/instruction_sets.hpp"

namespace spring_pendulum {

const ChainKernels kBaselineKernels = kernelsNamed("baseline");

}  // namespace spring_pendulum
