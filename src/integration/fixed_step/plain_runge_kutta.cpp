#include "integration/fixed_step/plain_runge_kutta.hpp"

#include <spring_pendulum/model/energy.hpp>

#include <utility>

namespace spring_pendulum {
namespace {

/// to += weight slope, from one particle on
void addWeighted(double weight, const State& slope, State& to, Eigen::Index first) {
  for (Eigen::Index c = 0; c < 4; ++c) {
    for (Eigen::Index i = first; i < to.size(); ++i) {
      to.values()(i, c) = fused(weight, slope.values()(i, c), to.values()(i, c));
    }
  }
}

}  // namespace

PlainRungeKutta::PlainRungeKutta(Chain chain, const ButcherTableau& tableau, bool track_dissipation)
    : chain_(std::move(chain)),
      tableau_(tableau),
      track_dissipation_(track_dissipation),
      stage_(chain_.size()),
      slopes_(tableau.stages, State(chain_.size())),
      accelerations_(chain_.size(), 2) {}

void PlainRungeKutta::advance(State& state, double time_step, std::int64_t steps) {
  state.velocities().row(0).setZero();
  for (std::int64_t n = 0; n < steps; ++n) step(state, time_step);
}

void PlainRungeKutta::step(State& state, double time_step) {
  for (std::size_t i = 0; i < tableau_.stages; ++i) {
    stage_.values() = state.values();
    for (std::size_t j = 0; j < i; ++j) {
      if (tableau_.a[i][j] == 0.0) continue;
      addWeighted(time_step * tableau_.a[i][j], slopes_[j], stage_, 0);
    }
    computeAccelerations(chain_, stage_, accelerations_);
    slopes_[i].positions() = stage_.velocities();
    slopes_[i].positions().row(0).setZero();
    slopes_[i].velocities() = accelerations_;
    ++force_evaluations_;
    if (track_dissipation_) {
      dissipated_energy_ += time_step * tableau_.b[i] * dissipatedPower(chain_, stage_);
    }
  }
  for (std::size_t i = 0; i < tableau_.stages; ++i) {
    if (tableau_.b[i] == 0.0) continue;
    addWeighted(time_step * tableau_.b[i], slopes_[i], state, 1);
  }
}

}  // namespace spring_pendulum
