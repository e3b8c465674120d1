#include "integration/fixed_step/plain_runge_kutta.hpp"

#include "base/checks.hpp"
#include "integration/kernels/stage_sum.hpp"

namespace spring_pendulum {

PlainRungeKutta::PlainRungeKutta(const Chain& chain, const ButcherTableau& tableau,
                                 bool track_dissipation, const ChainKernels& kernels)
    : SpringwiseIntegrator(DissipatedEnergy(chain.size(), chain.firstSpring())),
      tableau_(tableau),
      track_dissipation_(track_dissipation),
      damping_(chain.spring().damping),
      air_drag_(chain.airDrag()),
      constants_(chain),
      kernels_(kernels),
      held_work_(chain),
      state_(chain.size()),
      stage_(chain.size()) {
  for (std::size_t i = 0; i < tableau.stages; ++i) slopes_.emplace_back(chain.size());
}

void PlainRungeKutta::advance(State& state, double time_step, std::int64_t steps) {
  requireAdvance(constants_.chain().size, state.size(), time_step, steps);
  state.velocities().row(0).setZero();
  state_.values() = state.values();
  for (std::int64_t n = 0; n < steps; ++n) step(time_step);
  state.values().bottomRows(state.size() - 1) = state_.values().bottomRows(state.size() - 1);
}

void PlainRungeKutta::step(double time_step) {
  const Eigen::Index pitch = state_.pitch();
  for (std::size_t i = 0; i < tableau_.stages; ++i) {
    kernels_.combine(pitch, state_.data(), StageSum(time_step, tableau_.a[i], slopes_),
                     stage_.data());
    kernels_.stageSlope(constants_.chain(), stage_.data(), {}, slopes_[i].data());
    ++force_evaluations_;
    if (held_work_.isNeeded()) held_work_.add(stage_, time_step * tableau_.b[i]);
    if (!track_dissipation_ || tableau_.b[i] == 0.0) continue;
    const double weight = time_step * tableau_.b[i];
    dissipated_.addDrag(constants_.chain(), air_drag_, stage_, weight);
    if (damping_ != 0.0) {
      kernels_.addDissipation(constants_.chain(), stage_.data(), weight * damping_,
                              dissipated_.data());
    }
  }
  kernels_.combine(pitch, state_.data(), StageSum(time_step, tableau_.b, slopes_), state_.data());
}

}  // namespace spring_pendulum
