// The table of the kernels of the instruction set that the including file is compiled for.
#pragma once

#include <spring_pendulum/integration/chain_kernels.hpp>

#include <string_view>

#include "conveyor.hpp"
#include "stage_kernels.hpp"
#include "taylor_kernels.hpp"

namespace spring_pendulum {
namespace {

constexpr ChainKernels kernelsNamed(std::string_view name) {
  return {name,          stageSlope,        combine,       compensatedSum,
          largestChange, springsChangeMuch, advanceKernel, taylorSeries,
          taylorState,   taylorLargestSum,  taylorLargest};
}

}  // namespace
}  // namespace spring_pendulum
