// The weights of one tableau.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include <spring_pendulum/integration/butcher_tableau.hpp>

#include <cstddef>

namespace spring_pendulum {
namespace {

/// The part of `StepWeights` that a tableau uses. Copying all of it would take a quarter of the time
/// of a step of three particles.
template <const ButcherTableau& kTableau>
struct WeightsOf {
  explicit WeightsOf(const StepWeights& all) {
    for (std::size_t i = 0; i < kTableau.stages; ++i) {
      for (std::size_t j = 0; j <= i; ++j) after[i][j] = all.after[i][j];
      dissipation[i] = all.dissipation[i];
    }
  }

  double after[kTableau.stages][kTableau.stages];
  double dissipation[kTableau.stages];
};

}  // namespace
}  // namespace spring_pendulum
