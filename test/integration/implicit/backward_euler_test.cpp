#include "integration/implicit/backward_euler.hpp"

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/energy.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include "support/random_scenes.hpp"
#include "support/scenes.hpp"

namespace spring_pendulum {
namespace {

State after(const char* method, const test::Scene& scene, int steps) {
  State state = scene.start;
  makeIntegrator(method, scene.chain, {1e-10, false, 1})->advance(state, 1.0 / steps, steps);
  return state;
}

TEST(BackwardEuler, HasOrderOneAgainstRadau) {
  for (const double air_drag : {0.0, 0.5}) {
    test::Scene scene = test::horizontalChain("chain", 7, 1.0);
    scene.chain = test::inAir(scene.chain, air_drag);
    const State exact = after("Radau-9", scene, 1);
    const auto error = [&](int steps) {
      return (after("Backward-Euler", scene, steps).values() - exact.values()).norm();
    };
    EXPECT_NEAR(std::log2(error(20000) / error(40000)), 1.0, 0.05) << air_drag;  // 0.9997, 0.9997
  }
}

// One spring along y with the force -k (L - L_0) - d L' - m g - c v is linear in its unknowns.
TEST(BackwardEuler, SolvesTheEquationsOfALinearStep) {
  constexpr double kStep = 0.7, kStiffness = 50.0, kDamping = 0.5, kAir = 0.3, kMass = 2.0;
  const Chain still(Eigen::Vector2d(1.0, kMass), SpringLaw{kStiffness, kDamping, 1.0}, 9.81);
  const Chain chain = test::inAir(still, kAir);
  State state(2);
  state.y()[1] = -1.3;
  state.vy()[1] = -0.4;
  const double force = -kStiffness * (-1.3 + 1.0) - kMass * 9.81;
  const double expected = (kMass * -0.4 + kStep * force) /
                          (kMass + kStep * (kDamping + kAir) + kStep * kStep * kStiffness);
  BackwardEuler(chain, false).advance(state, kStep, 1);
  EXPECT_NEAR(state.vy()[1], expected, 1e-13);
  EXPECT_NEAR(state.y()[1], -1.3 + kStep * expected, 1e-13);
}

// With L_0 = 0 the potential is convex.
TEST(BackwardEuler, OnlyLosesEnergy) {
  for (const auto& [rest_length, gravity] : {std::pair{0.0, 9.81}, {1.0, 9.81}, {0.0, 0.0}})
    for (const double step : {1e-3, 0.1, 1.0, 10.0, 1e4}) {
      State state = test::horizontalChain("chain", 11, 1.0).start;
      const Chain chain(Eigen::VectorXd::Ones(11), {50.0, 0.0, rest_length}, gravity);
      BackwardEuler integrator(chain, false);
      double before = computeEnergy(chain, state).total();
      for (int n = 0; n < 200; ++n) {
        integrator.advance(state, step, 1);
        const double energy = computeEnergy(chain, state).total();
        ASSERT_LE(energy, before + 1e-9 * std::abs(before) + 1e-300) << step << " s, step " << n;
        before = energy;
      }
    }
}

TEST(BackwardEuler, SaysWhereNewtonsMethodDoesNotConverge) {
  int failures = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    test::Scene scene = test::randomScene(seed);
    BackwardEuler integrator(scene.chain, false);
    integrator.advance(scene.start, 0.5, 20);
    const bool finite = scene.start.values().allFinite();
    EXPECT_EQ(integrator.report().empty(), finite) << scene.name;
    if (finite) continue;
    ++failures;
    EXPECT_NE(integrator.report().find("did not converge"), std::string::npos);
    EXPECT_TRUE(scene.start.values().row(0).allFinite()) << scene.name;
    const std::int64_t evaluations = integrator.forceEvaluations();
    integrator.advance(scene.start, 1.0, 100);  // counts as work, so that limits on work end it
    EXPECT_GE(integrator.forceEvaluations(), evaluations + 100) << scene.name;
  }
  EXPECT_GT(failures, 0);
}

}  // namespace
}  // namespace spring_pendulum
