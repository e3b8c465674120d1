// Memory for the Taylor coefficients of a chain's motion, and the weights of the plain series.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/kernel_data.hpp"

#include <array>
#include <cstddef>

namespace spring_pendulum {

/// The reciprocals 1/i, which save divisions; element 0 is not used.
inline constexpr auto kReciprocals = [] {
  std::array<double, kLargestTaylorOrder + 2> reciprocals{};
  for (std::size_t i = 1; i < reciprocals.size(); ++i)
    reciprocals[i] = 1.0 / static_cast<double>(i);
  return reciprocals;
}();

/// Owns the coefficients to which a `TaylorWorkspace` points. `work.chain.size` and `work.order` may
/// be set to smaller values, and back up to their initial values.
struct TaylorExpansion {
  /// \param chain points to numbers that must outlive the expansion
  /// \param order K in 2..14, the largest number of coefficients
  TaylorExpansion(const KernelChain& chain, int order)
      : springs(chain.pitch * 4 * TaylorWorkspace::kSpringRows),
        accelerations(chain.pitch * 2 * order),
        work{chain, order, springs.data(), accelerations.data()} {}

  AlignedNumbers springs, accelerations;
  TaylorWorkspace work;
};

/// Returns whether a spring changes much (see `SpringChange`) within a step of h s.
/// \param middle returns the state in the middle of the step; called only if the ends leave it open
template <typename Middle>
bool springsChangeMuch(const ChainKernels& kernels, const TaylorWorkspace& work, double h,
                       const StateBuffer& begin, const StateBuffer& end, const Middle& middle) {
  const auto change_until = [&](double time, const StateBuffer& later) {
    return kernels.springChange(work.chain.size, work.chain.pitch, time, begin.data(),
                                later.data());
  };
  const SpringChange change = change_until(h, end);
  if (change != SpringChange::kUnclear) return change == SpringChange::kMuch;
  // A spring that shrinks to a negative length in the series can have its old length again at the
  // end of the step. The middle of the step shows it.
  return change_until(0.5 * h, middle()) == SpringChange::kMuch;
}

/// Returns the weights that sum the first `count` coefficients of the series at `time` s.
inline TaylorWeights taylorWeights(std::ptrdiff_t count, double time) {
  TaylorWeights weights;
  weights.count = count;
  weights.start_velocity = time;
  double power = time;
  for (std::size_t n = 0; n < static_cast<std::size_t>(count); ++n) {
    weights.velocity[n] = power * kReciprocals[n + 1];
    power *= time;
    weights.position[n] = power * (kReciprocals[n + 1] * kReciprocals[n + 2]);
  }
  return weights;
}

}  // namespace spring_pendulum
