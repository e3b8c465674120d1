// Properties of every method of the table, on random scenes.
#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/random_scenes.hpp"

namespace spring_pendulum {
namespace {

// Scenes that every method integrates quickly.
std::vector<test::Scene> quickScenes() {
  std::vector<test::Scene> scenes;
  for (unsigned seed = 2000; seed < 2060; ++seed) {
    test::Scene scene = test::randomScene(seed);
    const SpringLaw& spring = scene.chain.spring();
    const double lightest = scene.chain.masses().minCoeff();
    if (std::max(spring.damping, 1e-3 * spring.stiffness) > 1e4 * lightest) continue;
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

// Advances by steps that suit the method. A divergence is a result, too, but NaN is not equal to NaN.
State::Matrix advanced(Integrator& integrator, const Method& method, State state) {
  integrator.advance(state, method.hasFixedStep() ? 1e-4 : 0.05, method.hasFixedStep() ? 50 : 10);
  return state.values();
}

TEST(EveryMethod, RestartAndAnotherCallGiveTheSameBits) {
  const std::vector<test::Scene> scenes = quickScenes();
  EXPECT_GT(scenes.size(), 30);
  for (const Method& method : methodTable())
    for (const test::Scene& scene : scenes) {
      const auto integrator = makeIntegrator(method, scene.chain, {1e-4, false, 1});
      const State::Matrix first = advanced(*integrator, method, scene.start);
      integrator->restart();
      State second = scene.start;
      const double interval = method.hasFixedStep() ? 1e-4 : 0.05;
      integrator->advance(second, interval, 3);
      integrator->advance(second, interval, method.hasFixedStep() ? 47 : 7);
      EXPECT_EQ(first, second.values()) << method.name << ", " << scene.name;
    }
}

TEST(EveryMethod, RestartsAfterNaNAndKeepsTheFirstParticleAtRest) {
  for (const Method& method : methodTable()) {
    const test::Scene scene = test::randomScene(0);
    State moving = scene.start, broken = scene.start;
    moving.velocities().row(0) << 3.0, -4.0;
    broken.x()[broken.size() - 1] = NAN;  // has no effect after another restart
    const auto integrator = makeIntegrator(method, scene.chain, {1e-4, false, 1});
    const State::Matrix expected = advanced(*integrator, method, scene.start);
    integrator->restart();
    integrator->advance(broken, 1e-4, 1);
    integrator->restart();
    EXPECT_EQ(advanced(*integrator, method, moving), expected) << method.name;
  }
}

// The particle falls through the fixed one; steps of 1e-12 s lead through the collision.
TEST(EveryMethod, OutputTimesDoNotMakeADivergence) {
  const Chain chain(Eigen::Vector2d(1.0, 10.0), SpringLaw{}, 9.81);
  for (const Method& method : methodTable()) {
    if (method.hasFixedStep()) continue;
    for (const double interval : {0.1, 1.0, 10.0}) {
      State state(2);
      state.y()[1] = 1.0;
      makeIntegrator(method, chain)->advance(state, interval, 10);
      EXPECT_TRUE(state.values().allFinite()) << method.name << " every " << interval << " s";
    }
  }
}

}  // namespace
}  // namespace spring_pendulum
