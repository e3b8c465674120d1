// What a run says about itself: verdict, measured errors, remarks.
#include <spring_pendulum/simulation/run.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/program_run.hpp"
#include "support/reference.hpp"
#include "support/scenes.hpp"

namespace spring_pendulum {
namespace {

using testing::HasSubstr;

Scenario scenarioOf(std::string_view method) {
  Scenario scenario;
  scenario.method = findMethod(method);
  return scenario;
}

test::Scene horizontal(double damping = 1.0) {
  return test::horizontalChain("11 particles", 11, 1.0, {50.0, damping, 1.0});
}

test::ProgramRun runAfter(const Scenario& scenario, const test::Scene& scene, double seconds) {
  test::ProgramRun run(scenario, scene);
  run.advanceTo(seconds);
  return run;
}

// Measured: 2.495 m at 44.9 s (2.47 m in one coordinate); the energy error is 0.08 %.
TEST(Run, RungeKutta2IsInaccurate) {
  const test::ProgramRun run = runAfter(scenarioOf("Runge-Kutta-2"), horizontal(), 49.9);
  EXPECT_EQ(run.verdict().kind, VerdictKind::kInaccurate);
  EXPECT_NEAR(run.positionError().largest, 2.495, 0.01);
  EXPECT_THAT(run.measurements(), HasSubstr("largest position error 2.5 m at t = "));
}

// Measured: 3.9e-3 m.
TEST(Run, RungeKutta4IsOk) {
  const test::ProgramRun run = runAfter(scenarioOf("Runge-Kutta-4"), horizontal(), 49.9);
  EXPECT_EQ(run.verdict().kind, VerdictKind::kOk);
  EXPECT_NEAR(run.positionError().largest, 3.9e-3, 1e-4);
  EXPECT_LT(run.positionError().uncertainty, 1e-8);
  EXPECT_THAT(run.measurements(), HasSubstr("largest energy error "));
}

TEST(Run, PositionsAreNotCheckedWithoutAReference) {
  Scenario scenario = scenarioOf("Runge-Kutta-4");
  scenario.reference = ReferenceUse::kNever;
  const test::ProgramRun run = runAfter(scenario, horizontal(), 1.0);
  EXPECT_EQ(run.verdict().kind, VerdictKind::kNotChecked);
  EXPECT_TRUE(std::isnan(run.positionError().largest));
  EXPECT_THAT(run.measurements(), HasSubstr("position error not measured"));
}

TEST(Run, SaysUntilWhenItMeasured) {
  const test::Scene light = test::horizontalChain("light", 5000, 1e-3);
  Scenario scenario = scenarioOf("Stabilized-Taylor-8");
  scenario.tolerance = 1e-3;
  scenario.frame_interval = 0.01;
  const test::ProgramRun run = runAfter(scenario, light, 1.0);
  EXPECT_EQ(run.verdict().kind, VerdictKind::kNotChecked);
  EXPECT_GT(run.positionError().measured_until, 0.0);
  EXPECT_THAT(run.measurements(), HasSubstr("(measured until t = "));
}

TEST(Run, EnergyBalanceIsNotCheckedWhereItIsCostly) {
  Scenario scenario;
  EXPECT_TRUE(test::ProgramRun(scenario, horizontal()).tracksDissipation());
  scenario.frames = 100'000;
  const test::ProgramRun run = runAfter(scenario, horizontal(), 1.0);
  EXPECT_FALSE(run.tracksDissipation());
  EXPECT_TRUE(test::ProgramRun(scenario, horizontal(), {true}).tracksDissipation());
  EXPECT_EQ(run.verdict().kind, VerdictKind::kOk);
  EXPECT_THAT(run.measurements(), HasSubstr("energy balance not checked"));
}

TEST(Run, OscillatingEnergyOfSymplecticMethodsIsNotGained) {
  for (const Method& method : methodTable()) {
    for (const double damping : {0.0, 1.0}) {
      if (!method.symplectic) continue;
      Scenario scenario = scenarioOf(method.name);
      scenario.time_step = 0.05;
      scenario.steps_per_frame = 2;
      const test::ProgramRun run = runAfter(scenario, horizontal(damping), 20.0);
      EXPECT_LE(run.verdict().kind, VerdictKind::kInaccurate) << method.name << ' ' << damping;
    }
  }
}

TEST(Run, GrowingEnergyOfSymplecticMethodsIsFound) {
  Scenario scenario = scenarioOf("Velocity-Verlet");
  scenario.time_step = 0.2;  // above the stability limit of 0.142 s
  const test::ProgramRun run = runAfter(scenario, horizontal(0.0), 20.0);
  EXPECT_GE(run.verdict().kind, VerdictKind::kGainedEnergy);
}

// A position error of 5e-6 m, far below the tolerance, holds 4 % of the energy of this scene.
TEST(Run, ErrorWithinTheToleranceIsNotGainedEnergy) {
  const test::Scene lightest = test::horizontalChain("two particles", 2, 1e-9);
  Scenario scenario = scenarioOf("Auto");
  scenario.tolerance = 1e-3;
  EXPECT_EQ(runAfter(scenario, lightest, 10.0).verdict().text, "ok");
}

TEST(Run, SensitiveMotionIsNotBlamedOnTheRun) {
  Scenario scenario = scenarioOf("Auto");
  scenario.tolerance = 1e-8;
  test::Scene scene = test::horizontalChain("undamped", 11, 1.0, {500.0, 0.0, 1.0});
  const test::ProgramRun run = runAfter(scenario, scene, 20.0);
  EXPECT_EQ(run.verdict().kind, VerdictKind::kSensitive);
  EXPECT_THAT(run.verdict().text, HasSubstr("sensitive from t = "));
  EXPECT_THAT(run.toleranceRemark(), HasSubstr("no method can promise a tolerance of 1e-08 m"));
}

// A light particle buckles between heavy ones at 2.8 s. At 7.2 s, perturbations of the start have
// grown 52 times, those of a later state 125 times.
TEST(Run, MotionThatBecomesSensitiveLaterIsNotBlamedOnTheRun) {
  const Eigen::Vector4d masses{1.0, 1.0, 1e-4, 1.0};
  const test::Scene scene{"", Chain(masses, {50.0, 1.0, 1.0}, 9.81),
                          test::straightLine(4, 1.0, 0.0)};
  Scenario scenario = scenarioOf("Auto");
  scenario.tolerance = 1e-3;
  const test::ProgramRun run = runAfter(scenario, scene, 10.0);
  EXPECT_THAT(run.toleranceRemark(), HasSubstr("sensitive from t = 7.2 s"));
}

TEST(Run, StartsAnewAfterARestart) {
  test::ProgramRun run(scenarioOf("Euler"), horizontal());
  run.advanceTo(5.0);
  EXPECT_NE(run.verdict().kind, VerdictKind::kOk);
  run.reset();
  EXPECT_EQ(run.verdict().kind, VerdictKind::kOk);
  EXPECT_EQ(run.positionError().largest, 0.0);
}

struct KnownMotion {
  std::string scene;
  std::vector<int> times;  ///< s, with a solution in test/data/reference
};

class ReportedErrorOn : public testing::TestWithParam<KnownMotion> {};

std::string sceneName(const testing::TestParamInfo<KnownMotion>& motion) {
  return motion.param.scene;
}

INSTANTIATE_TEST_SUITE_P(Scenes, ReportedErrorOn,
                         testing::Values(KnownMotion{"single_vertical", {1, 2, 5, 10, 20, 50}},
                                         KnownMotion{"two_masses_45deg", {1, 2, 5, 10, 20, 50}},
                                         KnownMotion{"horizontal_11", {1, 2, 5, 10, 20, 50}},
                                         KnownMotion{"horizontal_1000", {1, 2}},
                                         KnownMotion{"light_100", {1, 5}},
                                         KnownMotion{"lighter_100", {1}}),
                         sceneName);

// Below its uncertainty the reference cannot resolve an error.
TEST_P(ReportedErrorOn, IsTrueWithinAFactorOfTwoForEveryMethod) {
  const test::Scene scene = test::referenceScene(GetParam().scene);
  for (const Method& method : methodTable()) {
    Scenario scenario = scenarioOf(method.name);
    scenario.reference = ReferenceUse::kAlways;
    scenario.frames = 501;
    for (const double tolerance : {1e-3, 1e-6}) {
      scenario.tolerance = tolerance;
      test::ProgramRun run(scenario, scene);
      for (const int time : GetParam().times) {
        run.advanceTo(time);
        if (!run.isShown()) break;
        const State exact = test::referenceSolution(GetParam().scene, time);
        const double error =
            (run.state().positions() - exact.positions()).rowwise().norm().maxCoeff();
        const PositionError& reported = run.positionError();
        SCOPED_TRACE(testing::Message() << method.name << " to " << tolerance << " m, " << time
                                        << " s: " << error << " m, reported " << reported.now);
        EXPECT_LE(reported.now, 2.0 * error + reported.uncertainty);
        EXPECT_GE(reported.now, 0.5 * error - reported.uncertainty);
      }
      if (method.hasFixedStep()) break;
    }
  }
}

}  // namespace
}  // namespace spring_pendulum
