// Air drag: tolerance and energy of every error-controlled method against solutions with 113 bits. The
// order of methods with fixed steps is tested with driven chains.
#include "model/chain_modes.hpp"
#include <spring_pendulum/model/energy.hpp>
#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/precise_motion.hpp"
#include "support/scenes.hpp"

namespace spring_pendulum {
namespace {

using test::PreciseMotion;
using test::Scene;

constexpr double kInterval = 0.1;  // s
constexpr int kFrames = 12;

/// Compares a run of an error-controlled method with the precise motion.
void expectTolerance(const Scene& scene, const Method& method, double tolerance,
                     const PreciseMotion& precise) {
  Scenario scenario;
  scenario.method = method;
  scenario.constants = scene.chain.constants();
  scenario.frames = kFrames + 1;
  scenario.tolerance = tolerance;
  scenario.frame_interval = kInterval;
  Run run(makeScene(scenario, {scene.chain.masses(), scene.start}), scenario, {true, 0.0, {}});
  while (run.advance()) {
  }
  EXPECT_FALSE(isBad(run.verdict().kind)) << run.verdict().text;
  const double error = precise.errorOf(run.state());
  EXPECT_LE(error, 10.0 * tolerance);
  EXPECT_GT(error, 0.0);
  EXPECT_LE(std::abs(run.energyEntry().relative_residual.value()),
            std::max(10.0 * tolerance, 1e-6));
}

Scene inAir(double mass, double damping, double air_drag) {
  Scene scene = test::horizontalChain("in air", 7, mass, {50.0, damping, 1.0});
  scene.chain = test::inAir(scene.chain, air_drag);
  return scene;
}

PreciseMotion preciseEnd(const Scene& scene) {
  PreciseMotion precise(scene);
  for (int frame = 0; frame < kFrames; ++frame) precise.advance(kInterval);
  return precise;
}

TEST(AirDrag, KeepsTheTolerance) {
  // Light particles: the air damps them with 50/s, and strongly: with 2000/s.
  for (const auto& [mass, damping, air_drag] :
       {std::tuple{1.0, 1.0, 0.5}, {1.0, 0.0, 0.2}, {1e-3, 1.0, 0.05}, {1e-3, 0.1, 2.0}}) {
    const Scene scene = inAir(mass, damping, air_drag);
    const PreciseMotion precise = preciseEnd(scene);
    for (const Method& method : methodTable()) {
      if (method.hasFixedStep()) continue;
      SCOPED_TRACE(method.name + " " + std::to_string(mass) + " " + std::to_string(air_drag));
      for (const double tolerance : {1e-5, 1e-8})
        expectTolerance(scene, method, tolerance, precise);
    }
  }
}

TEST(AirDrag, LimitsTheSpeedOfAFall) {
  const double mass = 0.5, drag = 0.7, time = 2.0;
  const Chain chain(Eigen::VectorXd::Constant(2, mass), {{0.0, 0.0, 1.0}, 9.81, drag});
  const double speed = 9.81 * mass / drag * (1.0 - std::exp(-drag / mass * time));
  for (const Method& method : methodTable()) {
    State state = test::straightLine(2, 1.0, 0.0);
    makeIntegrator(method, chain, {1e-9})->advance(state, 1e-3, 2000);
    EXPECT_NEAR(state.vy()[1], -speed, method.order == 1 ? 1e-2 : 1e-5) << method.name;
  }
}

TEST(AirDrag, EntersPowerAndRates) {
  const double drag = 0.6;
  const Chain chain(Eigen::VectorXd::Constant(3, 2.0), {{0.0, 0.0, 1.0}, 9.81, drag});
  State state = test::straightLine(3, 1.0, 0.0);
  state.vx()[1] = 3.0;
  state.vy()[2] = 4.0;
  EXPECT_DOUBLE_EQ(dissipatedPower(chain, state), drag * 25.0);
  EXPECT_DOUBLE_EQ(dissipatedPower(chain.drivenBy({{{2, {}}}, {}}), state), drag * 9.0);
  EXPECT_DOUBLE_EQ(largestDampingRate(chain), drag / 2.0);
}

}  // namespace
}  // namespace spring_pendulum
