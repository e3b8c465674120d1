// The table of kernels for the instruction set for which the including file is compiled.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/fast_tableaus.hpp"
#include "integration/kernels/stage_kernels.hpp"
#include "integration/kernels/stage_pipeline.hpp"
#include "integration/kernels/taylor_kernels.hpp"

#include <cstddef>
#include <iterator>
#include <string_view>
#include <utility>

namespace spring_pendulum {
namespace {

template <const ButcherTableau& kTableau, bool kDamped, bool kGravity, bool kDissipation>
void advance(const KernelChain& chain, const StepWeights& weights, std::ptrdiff_t steps,
             double* state, double* dissipated, double* workspace) {
  // Adding a gravity of 0 changes no bit and costs little time; this saves a compiled variant.
  using Short = StagePipeline<kTableau, kDamped, true, kDissipation>;
  if (Short::isShort(chain)) {
    return Short(chain, weights, state, dissipated, workspace).advanceShort(steps);
  }
  StagePipeline<kTableau, kDamped, kGravity, kDissipation>(chain, weights, state, dissipated,
                                                           workspace)
      .advance(steps);
}

template <const ButcherTableau& kTableau>
AdvanceKernel advanceKernelFor(StepNeeds needs) {
  if (!needs.damping) {
    return needs.gravity ? advance<kTableau, false, true, false>
                         : advance<kTableau, false, false, false>;
  }
  if (needs.dissipation) {
    return needs.gravity ? advance<kTableau, true, true, true>
                         : advance<kTableau, true, false, true>;
  }
  return needs.gravity ? advance<kTableau, true, true, false>
                       : advance<kTableau, true, false, false>;
}

template <std::size_t... kIndex>
AdvanceKernel advanceKernelAt(std::size_t tableau, StepNeeds needs,
                              std::index_sequence<kIndex...> /*tableaus*/) {
  AdvanceKernel kernel = nullptr;
  ((kernel = kIndex == tableau ? advanceKernelFor<*kFastTableaus[kIndex]>(needs) : kernel), ...);
  return kernel;
}

AdvanceKernel advanceKernel(std::size_t tableau, StepNeeds needs) {
  return advanceKernelAt(tableau, needs, std::make_index_sequence<std::size(kFastTableaus)>());
}

constexpr ChainKernels kernelsNamed(std::string_view name) {
  return {name,          stageSlope,       combine,         addWeighted,   compensatedSum,
          largestChange, springChange,     addDissipation,  advanceKernel, taylorSeries,
          taylorState,   taylorLargestSum, lastCoefficients};
}

}  // namespace
}  // namespace spring_pendulum
