// The table of kernels for the instruction set for which the including file is compiled.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/stage_kernels.hpp"
#include "integration/kernels/stage_pipeline.hpp"
#include "integration/kernels/taylor_kernels.hpp"

#include <cstddef>
#include <iterator>
#include <string_view>
#include <utility>

namespace spring_pendulum {
namespace {

template <const ButcherTableau& kTableau, bool kDamped, bool kDissipation>
void advance(const KernelChain& chain, const StepWeights& weights, std::ptrdiff_t steps,
             double* state, double* dissipated, double* workspace) {
  StagePipeline<kTableau, kDamped, kDissipation>(chain, weights, state, dissipated, workspace)
      .advance(steps);
}

template <const ButcherTableau& kTableau>
AdvanceKernel advanceKernelFor(StepNeeds needs) {
  if (!needs.damping) return advance<kTableau, false, false>;
  return needs.dissipation ? advance<kTableau, true, true> : advance<kTableau, true, false>;
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
