#include "ros/pendulum_run.hpp"

#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace spring_pendulum {
namespace {

Particles scene() {
  return readParticleFile(PROJECT_DIR "/data/particle.txt");
}

Scenario scenarioOf(std::string_view method) {
  Scenario scenario;
  scenario.method = findMethod(method);
  scenario.frames = 8;
  return scenario;
}

/// The states at the frames.
std::vector<State::Matrix> frames(PendulumRun& run, bool in_between) {
  std::vector<State::Matrix> states{run.state().values()};
  while (!run.isOver()) {
    run.advance(in_between);
    if (run.atFrame()) states.emplace_back(run.state().values());
  }
  return states;
}

TEST(PendulumRun, StatesInBetweenLeaveTheBitsOfTheFramesForEveryMethod) {
  for (const Method& method : methodTable()) {
    SCOPED_TRACE(method.name);
    const Scenario scenario = scenarioOf(method.name);
    PendulumRun plain(scenario, scene(), false, 0.0);
    const auto expected = frames(plain, false);
    ASSERT_EQ(expected.size(), 8U);
    for (const double interval : {0.06, 1.0 / 30.0, 0.0126, 0.001}) {
      PendulumRun shown(scenario, scene(), true, interval);
      EXPECT_TRUE(frames(shown, true) == expected) << interval;
      EXPECT_EQ(shown.time(), plain.time());
    }
  }
}

TEST(PendulumRun, AChainThatMayFallAsleepIsShownFrameByFrame) {
  Scenario scenario = scenarioOf("Runge-Kutta-4");
  scenario.sleep = 1e-3;
  PendulumRun run(scenario, scene(), false, 0.01);
  run.advance(true);
  EXPECT_EQ(run.frame(), 1);
}

TEST(PendulumRun, AFrameIsCutIntoWholeSteps) {
  PendulumRun run(scenarioOf("Runge-Kutta-4"), scene(), false, 1.0 / 30.0);
  std::vector<double> times;
  for (int i = 0; i < 6; ++i) {
    const double next = run.nextTime();
    run.advance(true);
    EXPECT_EQ(run.time(), next);
    times.push_back(run.time());
  }
  // A frame of 10 steps in 3 parts of 3, 3 and 4.
  const std::vector<double> expected{3 * 0.01,  6 * 0.01,  10 * 0.01,
                                     13 * 0.01, 16 * 0.01, 20 * 0.01};
  EXPECT_EQ(times, expected);
  EXPECT_EQ(run.frame(), 2);
  EXPECT_EQ(run.steps(), 20);
}

TEST(PendulumRun, NeverCutsFinerThanAStep) {
  PendulumRun run(scenarioOf("Euler"), scene(), false, 1e-9);
  run.advance(true);
  EXPECT_EQ(run.steps(), 1);
}

TEST(PendulumRun, ResetGivesTheSameRunAgain) {
  PendulumRun run(scenarioOf("Runge-Kutta-2"), scene(), true, 0.05);
  const auto first = frames(run, true);
  const double dissipated = run.energyEntry().dissipated.value();
  EXPECT_GT(dissipated, 0.0);
  run.reset();
  EXPECT_EQ(run.time(), 0.0);
  EXPECT_EQ(run.energyEntry().dissipated.value(), 0.0);
  EXPECT_TRUE(frames(run, false) == first);
  EXPECT_EQ(run.energyEntry().dissipated.value(), dissipated);
}

TEST(PendulumRun, MeasuresThePositionErrorAlsoBetweenFrames) {
  Scenario scenario = scenarioOf("Euler");
  PendulumRun plain(scenario, scene(), true, 0.0), shown(scenario, scene(), true, 0.02);
  frames(plain, false);
  shown.advance(true);
  ASSERT_FALSE(shown.atFrame());
  EXPECT_GT(shown.positionError().now, 0.0);
  EXPECT_EQ(shown.positionError().largest, 0.0);  // of frame 0
  ASSERT_NE(shown.referenceState(), nullptr);
  frames(shown, true);
  EXPECT_GT(shown.positionError().largest, 1e-3);
  EXPECT_EQ(shown.positionError().largest, plain.positionError().largest);
  EXPECT_EQ(shown.verdict().kind, plain.verdict().kind);
  scenario.reference = ReferenceUse::kNever;
  const PendulumRun unmeasured(scenario, scene(), true, 0.0);
  EXPECT_EQ(unmeasured.referenceState(), nullptr);
  EXPECT_EQ(unmeasured.verdict().kind, VerdictKind::kNotChecked);
}

TEST(PendulumRun, EndsWhereTheMotionDiverges) {
  Scenario scenario = scenarioOf("Euler");
  scenario.frames = 500;
  const Particles particles = readParticleFile(PROJECT_DIR "/data/horizontal_11.txt");
  PendulumRun run(scenario, particles, false, 0.0);
  while (!run.isOver()) run.advance(false);
  EXPECT_FALSE(run.isShown());
  EXPECT_LT(run.frame(), 499);
  scenario.on_divergence = OnDivergence::kContinue;
  PendulumRun continued(scenario, particles, false, 0.0);
  while (!continued.isOver()) continued.advance(false);
  EXPECT_GT(continued.frame(), run.frame());
  EXPECT_EQ(continued.verdict().kind, VerdictKind::kDiverged);
}

}  // namespace
}  // namespace spring_pendulum
