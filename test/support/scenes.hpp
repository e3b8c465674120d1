// Scenes and starts.
#pragma once

#include <cmath>
#include <random>
#include <string>

#include "support/scene.hpp"

namespace spring_pendulum::test {

/// P_i at (i - 1) (dx, dy), at rest.
inline State straightLine(Eigen::Index particles, double dx, double dy) {
  State state(particles);
  for (Eigen::Index i = 0; i < particles; ++i) {
    state.x()[i] = dx * static_cast<double>(i);
    state.y()[i] = dy * static_cast<double>(i);
  }
  return state;
}

/// Hanging at rest: spring i carries the weight of all particles beyond it.
inline State hangingAtRest(const Chain& chain) {
  State state(chain.size());
  double weight = 0.0;
  for (Eigen::Index i = 1; i < chain.size(); ++i) weight += chain.masses()[i] * chain.gravity();
  for (Eigen::Index i = 1; i < chain.size(); ++i) {
    const double length = chain.spring().rest_length + weight / chain.spring().stiffness;
    state.y()[i] = state.y()[i - 1] - length;
    weight -= chain.masses()[i] * chain.gravity();
  }
  return state;
}

inline Scene horizontalChain(const std::string& name, Eigen::Index particles, double mass,
                             const SpringLaw& spring = {}, double gravity = 9.81) {
  return {name, Chain(Eigen::VectorXd::Constant(particles, mass), spring, gravity),
          straightLine(particles, 1.0, 0.0)};
}

/// A chain of two to seven particles that moves chaotically: without gravity, without damping, weakly
/// damped, or with two particles that nearly coincide. Its start has a random shape.
inline Scene chaoticScene(unsigned seed) {
  std::mt19937 generator(seed);
  const auto uniform = [&](double least, double most) {
    return least + (most - least) * static_cast<double>(generator()) / 4294967296.0;
  };
  const auto size = static_cast<Eigen::Index>(2 + generator() % 6);
  SpringLaw spring{std::pow(10.0, uniform(1.0, 3.0)), 0.0, 1.0};
  Eigen::VectorXd masses(size);
  for (Eigen::Index i = 0; i < size; ++i)
    masses[i] = seed % 6 == 1 ? 1.0 : std::pow(10.0, uniform(-1.0, 0.3));
  State start(size);
  const auto place = [&](Eigen::Index i, double angle, double length) {
    start.x()[i] = start.x()[i - 1] + length * std::cos(angle);
    start.y()[i] = start.y()[i - 1] + length * std::sin(angle);
  };
  const double angle = uniform(-3.1, 3.1);
  for (Eigen::Index i = 1; i < size; ++i) {
    const double turned = angle + uniform(-1.2, 1.2);
    place(i, turned, uniform(0.8, 1.5));
  }
  if (seed % 6 == 2) spring.damping = std::pow(10.0, uniform(-3.0, -1.0));
  if (seed % 6 == 3 && size > 2) {
    const double length = std::pow(10.0, uniform(-10.0, -2.0));
    place(size - 1, uniform(-3.0, 3.0), length);
  }
  return {"chaotic " + std::to_string(seed), Chain(masses, spring, seed % 6 == 0 ? 0.0 : 9.81),
          start};
}

}  // namespace spring_pendulum::test
