// Extreme scenes: each must give a defined result and a correct verdict.
#include "simulation/judge.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/simulation/plan.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/verdict_of_run.hpp"

namespace spring_pendulum::test {
namespace {

constexpr double kThrown = 0.02237440318514361;  // m, the damped oscillation after 0.01 s

TEST(HardScenes, AParticleExactlyAtItsNeighbourFeelsNoSpringAndMovesOn) {
  const Chain chain(Eigen::VectorXd::Ones(2), SpringLaw{}, 0.0);
  for (const Method& method : methodTable()) {
    State state(2);
    state.vx()[1] = 2.0;  // L = 0 at the start
    makeIntegrator(method, chain)->advance(state, 1e-3, 10);
    EXPECT_TRUE(state.values().allFinite()) << method.name;
    // Without a force, it would get to 0.02 m. Euler is 7e-4 m behind, Taylor series 1e-12 m.
    EXPECT_NEAR(state.x()[1], kThrown, !method.hasFixedStep() ? 1e-5 : 1e-3) << method.name;
    EXPECT_EQ(state.y()[1], 0.0) << method.name;
  }
}

TEST(HardScenes, ParticlesThatStayAtTheSamePlaceCostNoMoreThanOthers) {
  const Chain chain(Eigen::VectorXd::Ones(3), SpringLaw{}, 0.0);
  for (const Method& method : methodTable()) {
    State state(3);
    state.x() << 0.0, 1.0, 1.0;
    const auto integrator = makeIntegrator(method, chain);
    integrator->advance(state, 0.01, 1000);
    EXPECT_EQ(state.x()[2], 1.0) << method.name;
    EXPECT_LE(integrator->forceEvaluations(), 4000) << method.name;
  }
}

TEST(HardScenes, FallingStraightThroughTheAnchorKeepsTheEnergy) {
  // A soft spring lets the particle through; the force jumps from one side to the other there.
  const Chain chain(Eigen::VectorXd::Ones(2), {1.0, 0.0, 0.5}, 9.81);
  Scene scene{"through the anchor", chain, State(2)};
  scene.start.y()[1] = 2.0;
  State state = scene.start;
  const auto integrator = makeIntegrator("Runge-Kutta-4", chain);
  const Judge balance(chain, state, {false});
  double lowest = 0.0, worst = 0.0;
  for (int frame = 1; frame <= 100; ++frame) {
    integrator->advance(state, 0.01, 10);
    lowest = std::min(lowest, state.y()[1]);
    worst =
        std::max(worst, std::abs(*balance.balanceOf(0.1 * frame, state, 0.0).relative_residual));
  }
  EXPECT_LT(lowest, -15.0);
  EXPECT_LT(worst, 1e-3);  // measured 2.7e-4: only the steps across the jump lose their order
}

// The series of a Taylor method is invalid beyond the anchor, and can come back within one step.
TEST(HardScenes, FallingStraightThroughTheAnchorKeepsTheTolerance) {
  struct Fall {
    double mass;
    SpringLaw spring;
    Eigen::RowVector2d start;
    double tolerance;
    double time;
  };
  const Fall falls[] = {
      {1.0168343010347412, {50.0, 1.0, 1.0}, {1.9521467068124763, -1.6410450671022894}, 1e-3, 0.8},
      {0.01741153152996637,
       {7.0495139259402864, 0.032862270915567988, 0.80250867485608635},
       {2.7846386308849254, -0.25046528193793416},
       1e-2,
       1.0}};
  for (const Fall& fall : falls) {
    const Chain chain(Eigen::Vector2d::Constant(fall.mass), fall.spring, 0.0);
    State start(2);
    start.positions().row(1) = fall.start;
    State exact = start;
    makeIntegrator("Dormand-Prince-5", chain, {1e-9})->advance(exact, fall.time, 1);
    for (const Method& method : methodTable()) {
      if (method.hasFixedStep()) continue;
      State state = start;
      makeIntegrator(method, chain, {fall.tolerance})->advance(state, fall.time, 1);
      EXPECT_LE((state.positions() - exact.positions()).row(1).norm(), 10.0 * fall.tolerance)
          << method.name << " " << fall.mass;
    }
  }
}

// At the rest length, the position error of a step vanishes, but not the velocity error. Measured: 2.3.
TEST(HardScenes, AFastUndampedVibrationKeepsTheTolerance) {
  const Chain chain(Eigen::Vector2d{1.0, 6.5e-6}, {50.0, 0.0, 1.0}, 9.81);
  State start(2);
  start.x()[1] = -0.3423;
  start.y()[1] = -0.0155;
  State exact = start;
  makeIntegrator("Taylor-12", chain, {1e-8})->advance(exact, 0.5, 6);
  for (const Method& method : methodTable()) {
    if (method.hasFixedStep()) continue;
    State state = start;
    makeIntegrator(method, chain, {1e-3})->advance(state, 0.5, 6);
    EXPECT_LE((state.positions() - exact.positions()).row(1).norm(), 1e-2) << method.name;
  }
}

TEST(HardScenes, NeighboursThatPassCloselyStayFinite) {
  for (const double miss : {1e-3, 1e-8, 1e-150, 5e-324}) {
    const Chain chain(Eigen::VectorXd::Ones(3), SpringLaw{}, 9.81);
    Scene scene{"close", chain, straightLine(3, 1.0, 0.0)};
    scene.start.x()[2] = miss;  // next to P_1, so P_2 is dragged back over both
    scene.start.y()[2] = miss;
    EXPECT_LE(verdictOfRun(scene, findMethod("Runge-Kutta-4"), 0.01, 20.0, true).kind,
              VerdictKind::kDrift)
        << miss;
  }
}

TEST(HardScenes, GravityUpwardsIsTheMirrorImageToTheLastBit) {
  Scene down = horizontalChain("", 6, 1.0);
  Scene up = horizontalChain("", 6, 1.0, {}, -9.81);
  makeIntegrator("Runge-Kutta-4", down.chain)->advance(down.start, 0.01, 1000);
  makeIntegrator("Runge-Kutta-4", up.chain)->advance(up.start, 0.01, 1000);
  EXPECT_EQ(down.start.x(), up.start.x());
  EXPECT_EQ(down.start.y(), -up.start.y());
}

TEST(HardScenes, OneTwoAndAMillionParticles) {
  for (const Eigen::Index particles : {1, 2, 1000000}) {
    const Scene scene = horizontalChain("", particles, 1.0);
    EXPECT_EQ(verdictOfRun(scene, findMethod("Runge-Kutta-4"), 0.01, 0.04, false).kind,
              VerdictKind::kOk);
  }
}

TEST(HardScenes, AChainAtRestStaysWithinRounding) {
  const Chain chain(Eigen::VectorXd::Ones(11), SpringLaw{}, 9.81);
  const State start = hangingAtRest(chain);
  for (const Method& method : methodTable()) {
    if (!method.hasFixedStep()) continue;
    State state = start;
    makeIntegrator(method, chain)->advance(state, 0.01, 10000);
    EXPECT_EQ(state.x(), start.x()) << method.name;
    const double moved = (state.positions() - start.positions()).cwiseAbs().maxCoeff();
    EXPECT_LT(moved, 1e-13) << method.name;  // the chain is 20.8 m long
  }
}

TEST(HardScenes, AChainAtRestWithoutGravityStaysToTheLastBit) {
  const Scene scene = horizontalChain("", 6, 1.0, {}, 0.0);
  for (const Method& method : methodTable()) {
    State state = scene.start;
    makeIntegrator(method, scene.chain)->advance(state, 0.01, 1000);
    EXPECT_EQ(state.values(), scene.start.values()) << method.name;
  }
}

TEST(HardScenes, TenMillionSteps) {
  const Chain chain(Eigen::VectorXd::Ones(2), {50.0, 0.0, 1.0}, 9.81);
  State state = straightLine(2, 1.0, 0.0);
  const Judge balance(chain, state, {false});
  makeIntegrator("Runge-Kutta-4", chain)->advance(state, 1e-3, 10000000);
  const double residual = *balance.balanceOf(1e4, state, 0.0).relative_residual;
  EXPECT_LT(std::abs(residual), 1e-7);  // measured -3.5e-9
  Scenario scenario;
  scenario.time_step = 1e-3;
  EXPECT_EQ(scenario.timeOfFrame(1000000), 1e4);  // no sum of a million roundings
}

TEST(HardScenes, AMotionThatDiesAwayEndsInRoundingAndNotInDenormalNumbers) {
  // Denormal numbers make a step about 20 times slower; lengths near 1 m never lead there.
  Scene scene = horizontalChain("", 11, 0.01, {}, 0.0);
  scene.start = straightLine(11, 1.1, 0.0);
  makeIntegrator("Runge-Kutta-4", scene.chain)->advance(scene.start, 0.005, 100000);
  for (Eigen::Index i = 1; i < 11; ++i) {
    EXPECT_NE(std::fpclassify(scene.start.vx()[i]), FP_SUBNORMAL);
    EXPECT_LT(std::abs(scene.start.vx()[i]), 1e-11);  // measured 2e-13
  }
}

}  // namespace
}  // namespace spring_pendulum::test
