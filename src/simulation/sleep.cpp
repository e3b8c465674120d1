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

}  // namespace spring_pendulum
