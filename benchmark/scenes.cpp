#include "scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/reference_table.hpp"

namespace spring_pendulum::benchmark {
namespace {

struct SceneName {
  const char* name;
  int seconds;
};
constexpr SceneName kScenes[] = {
    {"single_vertical", 5}, {"two_masses_45deg", 5}, {"horizontal_11", 5},  {"horizontal_1000", 2},
    {"light_100", 5},       {"lighter_100", 5},      {"alternating_50", 5}, {"feather_50", 5}};

double worst(double a, double b) {
  return std::isfinite(b) ? std::max(a, b) : std::numeric_limits<double>::infinity();
}

/// A steel cable without damping, hanging with unstretched springs and let go: 1,000 particles of 10 g,
/// 10 mm apart. No spring turns over, so the motion is linear and known: mode j of the n moving
/// particles is sin((2j-1) pi i / (2n+1)), and its angular frequency 2 sqrt(k_s/m) times the sine of
/// half that angle for i = 1 (docs/verification.md).
ReferenceScene stiffCable(double duration) {
  const std::size_t n = 999;
  const double mass = 0.01;
  ReferenceScene scene;
  Problem& problem = scene.problem;
  problem = horizontalChain(n + 1);
  problem.name = "cable_1000";
  problem.masses.assign(n + 1, mass);
  problem.stiffness = 5e5;
  problem.damping = 0.0;
  problem.rest_length = 0.01;
  scene.duration = duration;
  std::vector<double> stretch(n + 1);  // of the cable at rest, at each particle
  for (std::size_t i = 1; i <= n; ++i) {
    problem.start[i] = 0.0;
    problem.start[n + 1 + i] = -problem.rest_length * static_cast<double>(i);
    stretch[i] = stretch[i - 1] +
                 mass * problem.gravity / problem.stiffness * static_cast<double>(n + 1 - i);
  }
  scene.exact = problem.start;
  for (std::size_t i = 1; i <= n; ++i) scene.exact[n + 1 + i] -= stretch[i];
  const auto unknowns = static_cast<double>(2 * n + 1);
  for (std::size_t j = 1; j <= n; ++j) {
    const double angle = static_cast<double>(2 * j - 1) * 3.141592653589793 / unknowns;
    const double frequency = 2.0 * std::sqrt(problem.stiffness / mass) * std::sin(0.5 * angle);
    double amplitude = 0.0;
    for (std::size_t i = 1; i <= n; ++i) {
      amplitude += 4.0 / unknowns * stretch[i] * std::sin(angle * static_cast<double>(i));
    }
    for (std::size_t i = 1; i <= n; ++i) {
      const double shape = amplitude * std::sin(angle * static_cast<double>(i));
      scene.exact[n + 1 + i] += shape * std::cos(frequency * duration);
      scene.exact[3 * (n + 1) + i] -= shape * frequency * std::sin(frequency * duration);
    }
  }
  return scene;
}

}  // namespace

std::vector<ReferenceScene> referenceScenes() {
  std::vector<ReferenceScene> scenes;
  for (const SceneName& row : kScenes) {
    const auto table = test::readReferenceTable(REFERENCE_DIR, row.name);
    const auto& particles = table.columns;
    const auto* const exact = table.stateAfter(row.seconds);
    const std::size_t n = particles[0].size();
    ReferenceScene scene;
    scene.problem.name = row.name;
    scene.problem.masses = particles[2];
    scene.problem.start.assign(4 * n, 0.0);
    std::copy(particles[0].begin(), particles[0].end(), scene.problem.start.begin());
    std::copy(particles[1].begin(), particles[1].end(),
              scene.problem.start.begin() + static_cast<std::ptrdiff_t>(n));
    for (const auto* column = exact; column != exact + 4; ++column) {
      scene.exact.insert(scene.exact.end(), column->begin(), column->end());
    }
    scene.duration = row.seconds;
    scenes.push_back(std::move(scene));
  }
  scenes.push_back(stiffCable(1.0));
  return scenes;
}

Problem horizontalChain(std::size_t particles) {
  Problem problem;
  problem.name = fmt::format("horizontal_{}", particles);
  problem.masses.assign(particles, 1.0);
  problem.start.assign(4 * particles, 0.0);
  for (std::size_t i = 0; i < particles; ++i) problem.start[i] = static_cast<double>(i);
  return problem;
}

double positionError(const std::vector<double>& state, const std::vector<double>& exact) {
  const std::size_t n = exact.size() / 4;
  double error = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    error = worst(error, std::hypot(state[i] - exact[i], state[n + i] - exact[n + i]));
  }
  return error;
}

double stateDifference(const std::vector<double>& state, const std::vector<double>& other) {
  double difference = 0.0;
  for (std::size_t i = 0; i < other.size(); ++i) {
    difference = worst(difference, std::abs(state[i] - other[i]));
  }
  return difference;
}

}  // namespace spring_pendulum::benchmark
