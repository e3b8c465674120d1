// The tolerance on random scenes. `scripts/benchmark.sh tolerance` runs many more of them.
#include "support/random_scenes.hpp"

#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "support/exact_motion.hpp"
#include "support/reference.hpp"

namespace spring_pendulum::test {
namespace {

constexpr double kInterval = 0.5;  // s
constexpr int kOutputs = 6;
constexpr double kBudget = 0.25;          // s per scene; scenes that need more are skipped
constexpr double kLargestGrowth = 100.0;  // growth of perturbations of the start

/// Largest error at an output, in tolerances.
double errorInTolerances(const Scene& scene, const ExactMotion& exact, std::string_view method,
                         double tolerance) {
  const auto integrator = makeIntegrator(method, scene.chain, {tolerance});
  State state = scene.start;
  double worst = 0.0;
  for (const State& truth : exact.states) {
    integrator->advance(state, kInterval, 1);
    worst = std::max(worst, positionError(state, truth) / tolerance);
  }
  return state.values().allFinite() ? worst : std::numeric_limits<double>::infinity();
}

TEST(Oracle, FindsTheReferenceSolutions) {
  for (const char* name : {"two_masses_45deg", "horizontal_11"}) {
    const auto motion = exactMotion(referenceScene(name), 1.0, 2, 10.0);
    ASSERT_TRUE(motion);
    // Measured 5e-15.
    EXPECT_LT(positionError(motion->states[0], referenceSolution(name, 1)), 1e-13);
    EXPECT_LT(positionError(motion->states[1], referenceSolution(name, 2)), 1e-13);
  }
}

TEST(Oracle, MeasuresGrowthOfASmallChange) {
  // The angle of an inverted rigid pendulum grows with exp(sqrt(g/L) t).
  Scene scene{"", Chain(Eigen::Vector2d::Ones(), {1e5, 100.0, 1.0}, 9.81), State(2)};
  scene.start.y()[1] = 1.0 - 9.81 / 1e5;
  const auto motion = exactMotion(scene, 0.5, 4, 10.0);
  ASSERT_TRUE(motion);
  const double expected = std::cosh(std::sqrt(9.81) * 2.0);  // 262 for a change of 1
  EXPECT_GT(motion->growth, 0.05 * expected);
  EXPECT_LT(motion->growth, 1.1 * expected);
}

TEST(RandomScenes, KeepTheTolerance) {
  std::set<std::string> checked;  // families
  for (unsigned seed = 1000; seed < 1031; ++seed) {
    const Scene scene = randomScene(seed);
    const auto exact = exactMotion(scene, kInterval, kOutputs, kBudget);
    if (!exact || exact->growth > kLargestGrowth) continue;
    checked.insert(scene.name.substr(0, scene.name.rfind(' ')));
    for (const Method& method : methodTable()) {
      if (method.hasFixedStep()) continue;
      for (const double tolerance : {1e-3, 1e-6})
        EXPECT_LE(errorInTolerances(scene, *exact, method.name, tolerance), 10.0)
            << method.name << ", " << tolerance << " m, " << scene.name;
    }
  }
  EXPECT_GE(checked.size(), 15U);
}

}  // namespace
}  // namespace spring_pendulum::test
