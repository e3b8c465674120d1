// The table of kernels for the instruction set for which the including file is compiled.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/conveyor.hpp"
#include "integration/kernels/stage_kernels.hpp"
#include "integration/kernels/taylor_kernels.hpp"

#include <string_view>

namespace spring_pendulum {
namespace {

constexpr ChainKernels kernelsNamed(std::string_view name) {
  return {name,          stageSlope,       combine,         addWeighted,   compensatedSum,
          largestChange, springChange,     addDissipation,  advanceKernel, taylorSeries,
          taylorState,   taylorLargestSum, lastCoefficients};
}

}  // namespace
}  // namespace spring_pendulum
