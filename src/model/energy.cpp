#include "base/checks.hpp"
#include "model/block_sums.hpp"
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/model/energy.hpp>

namespace spring_pendulum {

Energy computeEnergy(const Chain& chain, const State& state) {
  requireSize(chain.size(), state.size());
  const SpringLaw& spring = chain.spring();
  const std::ptrdiff_t springs = chain.size() - 1;
  const std::ptrdiff_t block = sumBlockSize(springs);
  Energy energy;
  for (std::ptrdiff_t first = 0; first < springs; first += block) {
    const std::ptrdiff_t last = std::min(springs, first + block);
    Energy part;
    // Two loops: the call of fma in the first one makes all sums leave their registers.
    for (std::ptrdiff_t i = first; i < last; ++i) {  // spring i is to the right of particle i
      if (chain.isHeld(i) && chain.isHeld(i + 1)) continue;
      const double stretch = springLength(state, i) - spring.rest_length;
      part.spring += 0.5 * spring.stiffness * stretch * stretch;
    }
    for (std::ptrdiff_t i = first + 1; i <= last; ++i) {
      const double mass = chain.isHeld(i) ? 0.0 : chain.masses()[i];
      const double speed_squared = state.vx()[i] * state.vx()[i] + state.vy()[i] * state.vy()[i];
      part.kinetic += 0.5 * mass * speed_squared;
      part.gravity += mass * chain.gravity() * (state.y()[i] - state.y()[0]);
    }
    energy.kinetic += part.kinetic;
    energy.gravity += part.gravity;
    energy.spring += part.spring;
  }
  return energy;
}

double dissipatedPower(const Chain& chain, const State& state) {
  requireSize(chain.size(), state.size());
  double power = 0.0;
  for (Eigen::Index i = 1; i < chain.size(); ++i) {
    const Eigen::RowVector4d spring = state.values().row(i) - state.values().row(i - 1);
    const auto rate = elongationRate<double>({spring[0], spring[1]}, {spring[2], spring[3]});
    const bool is_idle = chain.isHeld(i - 1) && chain.isHeld(i);
    if (!is_idle) power = fused(chain.spring().damping, rate * rate, power);
    if (chain.airDrag() == 0.0 || chain.isHeld(i)) continue;
    const PlaneVector<double> velocity{state.vx()[i], state.vy()[i]};
    power = fused(chain.airDrag(), dotProduct(velocity, velocity), power);
  }
  return power;
}

}  // namespace spring_pendulum
