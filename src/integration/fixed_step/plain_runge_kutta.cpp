#include "integration/fixed_step/plain_runge_kutta.hpp"

#include "base/checks.hpp"
#include "integration/kernels/stage_sum.hpp"

namespace spring_pendulum {

PlainRungeKutta::PlainRungeKutta(const Chain& chain, const ButcherTableau& tableau,
                                 bool track_dissipation, const ChainKernels& kernels)
    : FixedStepIntegrator(chain, track_dissipation, kernels),
      tableau_(tableau),
      state_(chain.size()),
      stage_(chain.size()) {
  for (std::size_t i = 0; i < tableau.stages; ++i) slopes_.emplace_back(chain.size());
}

void PlainRungeKutta::integrate(State& state, double time_step, std::int64_t steps) {
  requireAdvance(chain().size, state.size(), time_step, steps);
  state.velocities().row(0).setZero();
  state_.values() = state.values();
  for (std::int64_t n = 0; n < steps; ++n) step(time_step);
  state.values().bottomRows(state.size() - 1) = state_.values().bottomRows(state.size() - 1);
}

void PlainRungeKutta::step(double time_step) {
  const Eigen::Index pitch = state_.pitch();
  for (std::size_t i = 0; i < tableau_.stages; ++i) {
    kernels().combine(pitch, state_.data(), StageSum(time_step, tableau_.a[i], slopes_),
                      stage_.data());
    evaluate(stage_, slopes_[i]);
    if (tableau_.b[i] != 0.0) addPowers(stage_, time_step * tableau_.b[i]);
  }
  kernels().combine(pitch, state_.data(), StageSum(time_step, tableau_.b, slopes_), state_.data());
}

}  // namespace spring_pendulum
