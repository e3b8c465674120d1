#include "integration/fixed_step/symplectic.hpp"

#include <utility>

namespace spring_pendulum {

SemiImplicitEuler::SemiImplicitEuler(const Chain& chain, bool track_dissipation)
    : SteppedIntegrator(chain, track_dissipation), slope_(chain.size()) {}

void SemiImplicitEuler::step(double time_step) {
  addPowers(current(), 0.5 * time_step);
  evaluate(current(), slope_);
  kick(current(), time_step, slope_);
  drift(current(), time_step);
  held_.place(current().values(), 1);
  addPowers(current(), 0.5 * time_step);
}

VelocityVerlet::VelocityVerlet(const Chain& chain, bool track_dissipation)
    : SteppedIntegrator(chain, track_dissipation),
      damped_(chain.isDissipative()),
      begin_slope_(chain.size()),
      end_slope_(chain.size()),
      predicted_(chain.size()) {}

void VelocityVerlet::step(double time_step) {
  addPowers(current(), 0.5 * time_step);
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
  held_.place(current().values(), 1);
  addPowers(current(), 0.5 * time_step);
}

}  // namespace spring_pendulum
