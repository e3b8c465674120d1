#include "simulation/sleep.hpp"

#include <spring_pendulum/model/dynamics.hpp>

namespace spring_pendulum {

bool isAtRest(const Chain& chain, const State& state, double duration, double tolerance) {
  const auto exceeds = [&](double x, double y) {
    return !(x * x + y * y <= tolerance * tolerance);
  };
  PlaneVector<double> left{};
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    const bool free_end = i + 1 == state.size();
    const auto right = free_end ? PlaneVector<double>{} : springForceOn(chain, state, i);
    if (i > 0) {
      const double gain = duration * chain.inverseMasses()[i];
      const double gain_x = (right.x - left.x) * gain;
      const double gain_y = (right.y - left.y) * gain - duration * chain.gravity();
      if (exceeds(state.vx()[i], state.vy()[i]) || exceeds(gain_x, gain_y)) return false;
    }
    left = right;
  }
  return true;
}

void SleepingIntegrator::advance(State& state, double time_step, std::int64_t steps) {
  const double duration = time_step * static_cast<double>(steps);
  if (tolerance_ > 0.0 && isAtRest(chain_, state, duration, tolerance_)) {
    asleep_ = true;
    ++slept_calls_;
    return;
  }
  if (asleep_) {
    // The integrator keeps data from before the sleep. Its restart also clears the dissipated
    // energy.
    dissipated_before_ += integrator_->dissipatedEnergy();
    integrator_->restart();
  }
  asleep_ = false;
  integrator_->advance(state, time_step, steps);
}

void SleepingIntegrator::restart() {
  asleep_ = false;
  dissipated_before_ = 0.0;
  integrator_->restart();
}

}  // namespace spring_pendulum
