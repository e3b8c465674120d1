// Scenes for tests of stability.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

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

/// Masses evenly spaced on a logarithmic scale from `least` kg over `decades`.
inline Scene randomMasses(unsigned seed, Eigen::Index particles, double least, double decades) {
  std::mt19937 generator(seed);
  Eigen::VectorXd masses(particles);
  for (Eigen::Index i = 0; i < particles; ++i) {
    masses[i] = least * std::pow(10.0, decades * static_cast<double>(generator()) / 4294967296.0);
  }
  return {"random masses " + std::to_string(seed), Chain(masses, SpringLaw{}, 9.81),
          straightLine(particles, 1.0, 0.0)};
}

inline Scene alternatingMasses(Eigen::Index particles, double light) {
  Eigen::VectorXd masses(particles);
  for (Eigen::Index i = 0; i < particles; ++i) masses[i] = i % 2 == 0 ? 1.0 : light;
  return {"alternating masses", Chain(masses, SpringLaw{}, 9.81),
          straightLine(particles, 1.0, 0.0)};
}

/// A light rope with a heavy bob at its end.
inline Scene heavyBob(const std::string& name, const SpringLaw& spring, double dx, double dy) {
  Eigen::VectorXd masses = Eigen::VectorXd::Constant(10, 0.05);
  masses[9] = 2.0;
  return {name, Chain(masses, spring, 9.81), straightLine(10, dx, dy)};
}

/// Hanging at rest, then displaced by up to 0.05 m.
inline Scene pluckedChain() {
  Scene scene = horizontalChain("plucked", 11, 1.0);
  scene.start = hangingAtRest(scene.chain);
  for (Eigen::Index i = 0; i < 11; ++i) {
    scene.start.x()[i] = 0.05 * std::sin(0.6 * static_cast<double>(i));
  }
  return scene;
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
  for (Eigen::Index i = 0; i < size; ++i) {
    masses[i] = seed % 6 == 1 ? 1.0 : std::pow(10.0, uniform(-1.0, 0.3));
  }
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

/// Returns scenes from stiff to soft, from damped to undamped, with one to fifty particles.
inline std::vector<Scene> stabilityScenes() {
  std::vector<Scene> scenes{
      {"one spring, hanging", Chain(Eigen::VectorXd::Ones(2), SpringLaw{}, 9.81),
       straightLine(2, 0.0, -1.3)},
      {"one light spring, hanging", Chain(Eigen::VectorXd::Constant(2, 0.01), SpringLaw{}, 9.81),
       straightLine(2, 0.0, -1.3)},
      horizontalChain("one light spring", 2, 0.01),
      horizontalChain("two springs", 3, 1.0),
      {"two springs at 45 degrees", Chain(Eigen::VectorXd::Ones(3), SpringLaw{}, 9.81),
       straightLine(3, 0.7071, -0.7071)},
      horizontalChain("6 particles", 6, 1.0),
      horizontalChain("6 particles, g 1000", 6, 0.3, {}, 1000.0),
      {"standing on its end", Chain(Eigen::VectorXd::Constant(5, 0.3), SpringLaw{}, 9.81),
       straightLine(5, 0.05, 1.0)},
      horizontalChain("11 particles", 11, 1.0),
      horizontalChain("m 0.1", 11, 0.1),
      horizontalChain("m 0.01", 11, 0.01),
      horizontalChain("m 0.001", 11, 0.001),
      horizontalChain("k_d 0", 11, 1.0, {50.0, 0.0, 1.0}),
      horizontalChain("m 0.01, k_d 0", 11, 0.01, {50.0, 0.0, 1.0}),
      horizontalChain("k_d 0.01", 11, 1.0, {50.0, 0.01, 1.0}),
      horizontalChain("k_d 10", 11, 1.0, {50.0, 10.0, 1.0}),
      horizontalChain("k_d 100", 11, 1.0, {50.0, 100.0, 1.0}),
      horizontalChain("k_s 5e3", 11, 1.0, {5e3, 1.0, 1.0}),
      horizontalChain("k_s 5e5", 11, 1.0, {5e5, 1.0, 1.0}),
      horizontalChain("k_s 5e5, k_d 100", 11, 1.0, {5e5, 100.0, 1.0}),
      horizontalChain("30 particles", 30, 1.0),
      horizontalChain("m 0.1, k_d 0.1", 30, 0.1, {50.0, 0.1, 1.0}),
      horizontalChain("50 particles, m 0.01", 50, 0.01),
      horizontalChain("200 particles", 200, 1.0),
      heavyBob("heavy bob", SpringLaw{}, 1.0, 0.0),
      heavyBob("heavy bob, hanging", SpringLaw{}, 0.3, -1.1),
      heavyBob("heavy bob, k_s 5e4", {5e4, 10.0, 1.0}, 1.0, 0.0),
      pluckedChain(),
      alternatingMasses(20, 1e-3),
  };
  for (unsigned seed = 1; seed <= 4; ++seed) scenes.push_back(randomMasses(seed, 12, 1e-5, 6.0));
  return scenes;
}

}  // namespace spring_pendulum::test
