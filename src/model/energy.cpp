#include "base/checks.hpp"
#include "model/block_sums.hpp"
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/model/energy.hpp>

namespace spring_pendulum {
namespace {

/// Returns the energies of the springs first <= i < last, where spring i is to the right of particle i,
/// and of the particles at their right ends.
Energy energyOfSprings(const Chain& chain, const State& state, std::ptrdiff_t first,
                       std::ptrdiff_t last) {
  Energy energy;
  const SpringLaw& spring = chain.spring();
  // Two loops: the call of fma in the first one makes all sums leave their registers.
  for (Eigen::Index i = first; i < last; ++i) {
    const double stretch = springLength(state, i) - spring.rest_length;
    energy.spring += 0.5 * spring.stiffness * stretch * stretch;
  }
  for (Eigen::Index i = first + 1; i <= last; ++i) {
    const double mass = chain.isHeld(i) ? 0.0 : chain.masses()[i];
    const double speed_squared = state.vx()[i] * state.vx()[i] + state.vy()[i] * state.vy()[i];
    energy.kinetic += 0.5 * mass * speed_squared;
    energy.gravity += mass * chain.gravity() * (state.y()[i] - state.y()[0]);
  }
  return energy;
}

}  // namespace

Energy computeEnergy(const Chain& chain, const State& state) {
  requireSize(chain.size(), state.size());
  Energy energy;
  const std::ptrdiff_t springs = chain.size() - 1;
  const std::ptrdiff_t block = sumBlockSize(springs);
  for (std::ptrdiff_t first = 0; first < springs; first += block) {
    const Energy part = energyOfSprings(chain, state, first, std::min(springs, first + block));
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
    const auto rate = elongationRate<double>(
        {state.x()[i] - state.x()[i - 1], state.y()[i] - state.y()[i - 1]},
        {state.vx()[i] - state.vx()[i - 1], state.vy()[i] - state.vy()[i - 1]});
    power = fused(chain.spring().damping, rate * rate, power);
    if (chain.airDrag() == 0.0 || chain.isHeld(i)) continue;
    const PlaneVector<double> velocity{state.vx()[i], state.vy()[i]};
    power = fused(chain.airDrag(), squaredLength(velocity), power);
  }
  return power;
}

}  // namespace spring_pendulum
