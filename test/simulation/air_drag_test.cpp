// Air drag: accuracy, order and energy of every method against solutions with 113 bits.
#include "model/chain_modes.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/energy.hpp>
#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "support/precise_motion.hpp"
#include "support/scenes.hpp"

namespace spring_pendulum {
namespace {

using test::PreciseMotion;
using test::Scene;

constexpr double kInterval = 0.1;  // s
constexpr int kFrames = 12;

struct Outcome {
  double error;     ///< m
  double residual;  ///< of the energy balance, relative
};

/// Compares a run with the precise motion.
/// \param steps per frame, of a fixed-step method
Outcome outcomeOf(const Scene& scene, const Method& method, double tolerance, std::int64_t steps,
                  const PreciseMotion& precise) {
  Scenario scenario;
  scenario.method = method;
  scenario.constants = scene.chain.constants();
  scenario.frames = kFrames + 1;
  scenario.steps_per_frame = steps;
  scenario.time_step = kInterval / static_cast<double>(steps);
  scenario.tolerance = tolerance;
  scenario.frame_interval = kInterval;
  Run run(makeScene(scenario, {scene.chain.masses(), scene.start}), scenario, {true, 0.0, {}});
  while (run.advance()) {
  }
  EXPECT_FALSE(isBad(run.verdict().kind)) << method.name << ": " << run.verdict().text;
  return {precise.errorOf(run.state()), std::abs(run.energyEntry().relative_residual.value())};
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

TEST(AirDrag, KeepsTheOrderOfFixedStepMethods) {
  for (const double damping : {1.0, 0.0}) {
    const Scene scene = inAir(1.0, damping, 0.5);
    const PreciseMotion precise = preciseEnd(scene);
    for (const Method& method : methodTable()) {
      if (!method.hasFixedStep()) continue;
      const std::int64_t steps = method.order == 1 ? 400 : method.order == 2 ? 160 : 10;
      const Outcome coarse = outcomeOf(scene, method, 1e-6, steps, precise);
      const Outcome fine = outcomeOf(scene, method, 1e-6, 2 * steps, precise);
      EXPECT_NEAR(std::log2(coarse.error / fine.error), method.order, 0.3) << method.name;
      EXPECT_GT(std::log2(coarse.residual / fine.residual), method.order - 0.75) << method.name;
    }
  }
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
      for (const double tolerance : {1e-5, 1e-8}) {
        const Outcome outcome = outcomeOf(scene, method, tolerance, 1, precise);
        EXPECT_LE(outcome.error, 10.0 * tolerance);
        EXPECT_GT(outcome.error, 0.0);
        EXPECT_LE(outcome.residual, std::max(10.0 * tolerance, 1e-6));
      }
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

TEST(AirDrag, RefusesWhatIsNoDrag) {
  const Chain chain(Eigen::VectorXd::Ones(3), {}, 9.81);
  for (const double drag : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(test::inAir(chain, drag), InputError);
    Scenario scenario;
    scenario.constants.air_drag = drag;
    const spring_pendulum::Scene particles{chain.masses(), test::straightLine(3, 1.0, 0.0)};
    EXPECT_THROW(spring_pendulum::Run(makeScene(scenario, particles), scenario), InputError);
  }
}

}  // namespace
}  // namespace spring_pendulum
