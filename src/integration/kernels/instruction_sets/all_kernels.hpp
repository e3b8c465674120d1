// The table of the kernels of the instruction set that the including file is compiled for.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/conveyor.hpp"
#include "integration/kernels/stage_kernels.hpp"
#include "integration/kernels/taylor_kernels.hpp"

#include <string_view>

namespace spring_pendulum {
namespace {

constexpr ChainKernels kernelsNamed(std::string_view name) {
  return {name,          stageSlope,        combine,      addWeighted,   compensatedSum,
          largestChange, springsChangeMuch, addHeat,      advanceKernel, taylorSeries,
          taylorState,   taylorLargestSum,  taylorLargest};
}

}  // namespace
}  // namespace spring_pendulum
