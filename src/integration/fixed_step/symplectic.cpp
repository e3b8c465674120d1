#include "integration/fixed_step/symplectic.hpp"

#include "base/checks.hpp"

#include <utility>

namespace spring_pendulum {

SymplecticMethod::SymplecticMethod(const Chain& chain, bool track_dissipation)
    : FixedStepIntegrator(chain, track_dissipation, fastestChainKernels()),
      current_(chain.size()) {}

void SymplecticMethod::integrate(State& state, double time_step, std::int64_t steps) {
  requireAdvance(chain().size, state.size(), time_step, steps);
  state.velocities().row(0).setZero();
  current_.values() = state.values();
  for (std::int64_t n = 0; n < steps; ++n) {
    addPowers(current_, 0.5 * time_step);
    step(time_step);
    addPowers(current_, 0.5 * time_step);
  }
  state.values() = current_.values();
}

void SymplecticMethod::kick(StateBuffer& state, double weight, const StateBuffer& slope) const {
  const Eigen::Index velocities = 2 * state.pitch();
  kernels().addWeighted(velocities, weight, slope.data() + velocities, state.data() + velocities);
}

void SymplecticMethod::drift(StateBuffer& state, double weight) const {
  const Eigen::Index positions = 2 * state.pitch();
  kernels().addWeighted(positions, weight, state.data() + positions, state.data());
}

SemiImplicitEuler::SemiImplicitEuler(const Chain& chain, bool track_dissipation)
    : SymplecticMethod(chain, track_dissipation), slope_(chain.size()) {}

void SemiImplicitEuler::step(double time_step) {
  evaluate(current(), slope_);
  kick(current(), time_step, slope_);
  drift(current(), time_step);
}

VelocityVerlet::VelocityVerlet(const Chain& chain, bool track_dissipation)
    : SymplecticMethod(chain, track_dissipation),
      damped_(chain.isDissipative()),
      begin_slope_(chain.size()),
      end_slope_(chain.size()),
      predicted_(chain.size()) {}

void VelocityVerlet::step(double time_step) {
  if (damped_ || !begin_slope_known_) evaluate(current(), begin_slope_);
  kick(current(), 0.5 * time_step, begin_slope_);
  drift(current(), time_step);
  if (damped_) {
    predicted_.values() = current().values();
    kick(predicted_, 0.5 * time_step, begin_slope_);
    evaluate(predicted_, end_slope_);
  } else {
    evaluate(current(), end_slope_);
  }
  kick(current(), 0.5 * time_step, end_slope_);
  std::swap(begin_slope_, end_slope_);
  begin_slope_known_ = true;
}

}  // namespace spring_pendulum
