#include "scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

namespace spring_pendulum::benchmark {
namespace {

struct SceneName {
  const char* name;
  int seconds;
};
constexpr SceneName kScenes[] = {
    {"single_vertical", 5}, {"two_masses_45deg", 5}, {"horizontal_11", 5},  {"horizontal_1000", 2},
    {"light_100", 5},       {"lighter_100", 5},      {"alternating_50", 5}, {"feather_50", 5}};

/// Columns of a table of numbers; empty if there is no such file.
std::vector<std::vector<double>> readColumns(const std::string& path, std::size_t columns) {
  std::ifstream file(path);
  std::vector<std::vector<double>> table(columns);
  double value = 0.0;
  for (std::size_t i = 0; file >> value; ++i) table[i % columns].push_back(value);
  return table;
}

double worst(double a, double b) {
  return std::isfinite(b) ? std::max(a, b) : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<ReferenceScene> referenceScenes() {
  std::vector<ReferenceScene> scenes;
  for (const SceneName& row : kScenes) {
    const std::string folder = REFERENCE_DIR;
    const auto particles = readColumns(fmt::format("{}/{}.txt", folder, row.name), 3);
    const auto exact = readColumns(fmt::format("{}/{}_t{}.txt", folder, row.name, row.seconds), 4);
    const std::size_t n = particles[0].size();
    if (n == 0 || exact[3].size() != n) continue;
    ReferenceScene scene;
    scene.problem.name = row.name;
    scene.problem.masses = particles[2];
    scene.problem.start.assign(4 * n, 0.0);
    std::copy(particles[0].begin(), particles[0].end(), scene.problem.start.begin());
    std::copy(particles[1].begin(), particles[1].end(),
              scene.problem.start.begin() + static_cast<std::ptrdiff_t>(n));
    for (const auto& column : exact) {
      scene.exact.insert(scene.exact.end(), column.begin(), column.end());
    }
    scene.duration = row.seconds;
    scenes.push_back(std::move(scene));
  }
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
