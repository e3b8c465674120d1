// The statements of data/README.md about each scene.
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/model/energy.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

namespace spring_pendulum {
namespace {

/// Total energy of each of the 500 frames minus that of the first one, J.
std::vector<double> energyGains(const std::string& scene, const std::string& method) {
  const Scenario scenario;
  Scene particles = readParticleFile(PROJECT_DIR "/data/" + scene);
  const Chain chain(particles.masses, scenario.constants);
  const auto integrator = makeIntegrator(method, chain);
  const double start = computeEnergy(chain, particles.state).total();
  std::vector<double> gains{0.0};
  for (std::int64_t frame = 1; frame < scenario.frames; ++frame) {
    integrator->advance(particles.state, scenario.time_step, scenario.steps_per_frame);
    gains.push_back(computeEnergy(chain, particles.state).total() - start);
  }
  return gains;
}

double largest(const std::vector<double>& values) {
  double result = values.front();
  for (const double value : values) {
    if (!std::isfinite(value)) return std::numeric_limits<double>::infinity();
    result = std::max(result, value);
  }
  return result;
}

constexpr double kExploded = 1e20, kInfinity = std::numeric_limits<double>::infinity();
/// How far Euler's energy rises above its start within the 500 frames, J: at least and at most.
constexpr std::tuple<const char*, double, double> kEulerGains[] = {
    {"particle.txt", 20.0, 21.5},  // measured 20.74
    {"horizontal_11.txt", kExploded, kInfinity},
    {"one_spring.txt", 0.005, 0.0065},        // 0.00586
    {"two_masses.txt", 11.0, 12.0},           // 11.56
    {"hanging_plucked.txt", 1000.0, 3000.0},  // 1693
    {"heavy_bob.txt", kExploded, kInfinity},
    {"random_masses.txt", kExploded, kInfinity},
    {"folded_20.txt", kExploded, kInfinity},
};

TEST(DataScenes, EulerGainsEnergyOnEachOfThem) {
  for (const auto& [scene, least, most] : kEulerGains) {
    const double gain = largest(energyGains(scene, "Euler"));
    EXPECT_TRUE(least <= gain && gain <= most) << scene << " " << gain;
  }
}

TEST(DataScenes, TheOtherMethodsOfTheExerciseNeverGainEnergy) {
  for (const auto& [scene, least, most] : kEulerGains)
    for (const char* method : {"Runge-Kutta-2", "Runge-Kutta-4"}) {
      const std::vector<double> gains = energyGains(scene, method);
      EXPECT_TRUE(largest(gains) <= 0.0 && gains.back() < 0.0) << scene << " " << method;
    }
}

TEST(DataScenes, NoneIsMissingAbove) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PROJECT_DIR "/data"))
    scenes += entry.path().extension() == ".txt" ? 1 : 0;
  EXPECT_EQ(scenes, static_cast<int>(std::size(kEulerGains)));
}

}  // namespace
}  // namespace spring_pendulum
