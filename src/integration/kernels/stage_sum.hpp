// Weighted sums of the slopes of a Runge-Kutta method.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/state_buffer.hpp"
#include <spring_pendulum/integration/butcher_tableau.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace spring_pendulum {

/// The sum of h * weight * slope over the slopes of all stages. Terms with weight 0 are left out.
class StageSum {
 public:
  /// \param slopes at most `ButcherTableau::kMaxStages`; must outlive the sum
  StageSum(double h, const std::array<double, ButcherTableau::kMaxStages>& weights,
           const std::vector<StateBuffer>& slopes) {
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      if (weights[i] != 0.0) terms_[count_++] = {h * weights[i], slopes[i].data()};
    }
  }
  operator SlopeSum() const {  // NOLINT(google-explicit-constructor)
    return {terms_.data(), static_cast<std::ptrdiff_t>(count_)};
  }

 private:
  std::array<WeightedSlope, ButcherTableau::kMaxStages> terms_{};
  std::size_t count_ = 0;
};

}  // namespace spring_pendulum
