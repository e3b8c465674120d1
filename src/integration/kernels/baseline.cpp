#include "all_kernels.hpp"
#include "instruction_sets.hpp"

namespace spring_pendulum {

const ChainKernels kBaselineKernels = kernelsNamed("baseline");

}  // namespace spring_pendulum
