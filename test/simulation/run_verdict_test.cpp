// What a run says about itself: verdict, measured errors, remarks.
#include <spring_pendulum/simulation/run.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <tuple>
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
}

TEST(Run, SaysUntilWhenItMeasured) {
  test::Scene light = test::horizontalChain("light", 5000, 1e-3);
  light.start = test::hangingAtRest(light.chain);
  light.start.x().tail(2500).array() += 0.1;  // all particles take part in the motion
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
  EXPECT_TRUE(test::ProgramRun(scenario, horizontal()).energyEntry().dissipated);
  scenario.frames = 100'000;
  const test::ProgramRun run = runAfter(scenario, horizontal(), 1.0);
  EXPECT_FALSE(run.energyEntry().dissipated);
  EXPECT_TRUE(test::ProgramRun(scenario, horizontal(), {true}).energyEntry().dissipated);
  EXPECT_EQ(run.verdict().kind, VerdictKind::kOk);
  EXPECT_THAT(run.measurements(), HasSubstr("energy balance not checked"));
  scenario.method = findMethod("Velocity-Verlet");
  scenario.frames = 10'000'000;
  scenario.time_step = 0.1;
  test::Scene spring = test::horizontalChain("spring", 2, 1.0, {50.0, 1e-5, 1.0}, 0.0);
  spring.start.x()[1] = 1.5;
  const test::ProgramRun coarse = runAfter(scenario, spring, 20.0);
  EXPECT_FALSE(coarse.energyEntry().dissipated);
  EXPECT_LE(coarse.verdict().kind, VerdictKind::kInaccurate) << coarse.verdict().text;
}

TEST(Run, OscillatingEnergyOfSymplecticMethodsIsNotGained) {
  for (const char* method : {"Semi-Implicit-Euler", "Velocity-Verlet"})
    for (const double damping : {0.0, 1.0}) {
      Scenario scenario = scenarioOf(method);
      scenario.time_step = 0.05;
      const Chain chain(Eigen::Vector4d(1e200, 1.0, 1.0, 1.0), {50.0, damping, 1.0}, 9.81);
      const auto run = runAfter(scenario, {"", chain, test::straightLine(4, 1.0, 0.0)}, 20.0);
      EXPECT_LE(run.verdict().kind, VerdictKind::kInaccurate) << method << ' ' << damping;
    }
}

TEST(Run, JudgesAFallThatStartsWithoutAnyEnergyOfItsOwn) {
  test::Scene fall = test::horizontalChain("fall", 2, 2.0, {0.0, 0.0, 0.0});
  fall.start.y()[1] = -1.0;  // below P_1
  EXPECT_LE(runAfter(scenarioOf("Semi-Implicit-Euler"), fall, 1.0).verdict().kind,
            VerdictKind::kInaccurate);
}

// Frames meet the oscillation of the energy in a few phases only, but the modified energy is constant.
TEST(Run, TheModifiedEnergyOfALinearChainIsConserved) {
  test::Scene scene = test::horizontalChain("spring", 2, 1.0, {50.0, 0.0, 1.0}, 0.0);
  for (const char* method : {"Semi-Implicit-Euler", "Velocity-Verlet"})
    for (const auto& [rate, start, speed] :
         {std::tuple{0.1, 0.004, 0.0}, {0.6, 0.002828427, 0.02}, {0.8, 0.004, 0.0}})
      for (const int steps : {1, 5, 10, 25}) {
        Scenario scenario = scenarioOf(method);
        scenario.time_step = rate / std::sqrt(50.0);
        scenario.steps_per_frame = steps;
        scene.start.x()[1] = 1.0 + start;
        scene.start.vx()[1] = speed;
        const double time = 40 * steps * scenario.time_step;
        test::ProgramRun run = runAfter(scenario, scene, time);
        run.change(scenario, {{70.0, 0.0, 1.0}, 0.0}, {{{0, {0.1, 0.0}}}, {}}, run.state());
        run.advanceTo(2.0 * time);
        run.change(scenario, run.chain().constants(), {{{0, {}}, {1, {5.0, 0.0}}}, {}},
                   run.state());
        run.advanceTo(3.0 * time);
        run.change(scenario, {{70.0, 0.5, 1.0}, 0.0}, {}, run.state());
        run.advanceTo(4.0 * time);
        EXPECT_LE(run.verdict().kind, VerdictKind::kInaccurate) << rate << run.verdict().text;
      }
}

TEST(Run, TheOscillationOfASymplecticMethodIsNoFaultOfAnother) {
  for (const double time : {0.5, 1.0, 1.5, 2.0}) {
    Scenario scenario = scenarioOf("Semi-Implicit-Euler");
    scenario.time_step = 0.03;
    test::ProgramRun run = runAfter(scenario, horizontal(0.0), time);
    run.change(scenarioOf("Runge-Kutta-4"), run.chain().constants(), {}, run.state());
    run.advanceTo(2.0 * time);
    EXPECT_LE(run.verdict().kind, VerdictKind::kInaccurate) << time << run.verdict().text;
  }
}

TEST(Run, TheStartAloneIsNoMeasuredError) {
  Scenario scenario = scenarioOf("Auto");
  scenario.frame_interval = 1000.0;
  test::ProgramRun run(scenario, horizontal(0.0));
  run.advance();
  run.advance();
  EXPECT_TRUE(std::isnan(run.positionError().largest) && std::isnan(run.positionError().bound));
  EXPECT_THAT(run.measurements(), HasSubstr("position error not measured"));
}

TEST(Run, ASingleDrivenParticleHasNoReferenceRun) {
  test::ProgramRun run(scenarioOf("Auto"), test::horizontalChain("one", 1, 1.0));
  run.advance();
  run.change(run.plan(), run.chain().constants(), {{{0, {0.5, 0.0}}}, {}}, run.state());
  run.reset();
  run.advanceTo(1.0);
  EXPECT_EQ(run.verdict().kind, VerdictKind::kNotChecked) << run.verdict().text;
}

TEST(Run, NamesAFreeParticleThatDiverged) {
  Scenario scenario = scenarioOf("Runge-Kutta-2");
  scenario.time_step = 0.08;
  test::Scene scene = test::horizontalChain("row", 6, 1.0, {50.0, 0.0, 1.0}, 0.0);
  Eigen::VectorXd masses = scene.chain.masses();
  masses[1] = 1000.0;
  scene.chain = Chain(masses, scene.chain.spring(), 0.0);
  scene.start.vy()[1] = 20.0;
  test::ProgramRun run(scenario, scene);
  run.advance();
  run.change(scenario, run.chain().constants(), {{{1, {}}}, {}}, run.state());
  run.advanceTo(100.0);
  EXPECT_GT(run.verdict().particle, 2) << run.verdict().text;
}

TEST(Run, TheMeanEnergyOfASymplecticMethodIsThatSinceTheLastChange) {
  Scenario scenario = scenarioOf("Runge-Kutta-4"), changed = scenarioOf("Semi-Implicit-Euler");
  scenario.time_step = 0.02;
  const test::Scene scene = test::horizontalChain("three", 3, 1.0, {50.0, 0.0, 1.0});
  for (const double time : {13.2, 17.6, 18.4, 20.0}) {
    test::ProgramRun run = runAfter(scenario, scene, time);
    run.change(changed, run.chain().constants(), {}, run.state());
    run.advanceTo(40.0);
    EXPECT_LE(run.verdict().kind, VerdictKind::kInaccurate) << run.verdict().text;
  }
  scenario = scenarioOf("Velocity-Verlet");
  scenario.frames = 11000;
  test::ProgramRun run = runAfter(scenario, scene, 1000.0);
  run.change(scenario, {{8e3, 0.0, 1.0}}, {}, run.state());
  run.advanceTo(1060.0);
  EXPECT_EQ(run.verdict().kind, VerdictKind::kDrift);
}

TEST(Run, AWrongDissipatedEnergyIsNoDriftAfterTheReferenceEither) {
  test::Scene scene = test::horizontalChain("transient", 3, 1.0, {50.0, 50.0, 1.0});
  scene.start.vx() << 0.0, 3.0, -3.0;
  for (const char* method : {"Runge-Kutta-4", "Velocity-Verlet"}) {
    test::ProgramRun run = runAfter(scenarioOf(method), scene, 1.0);
    EXPECT_GT(run.largestEnergyError(), 0.03);
    run.change(run.plan(), run.chain().constants(), {{}, {{2, {1e-3, 0.0}}}}, run.state());
    run.advanceTo(9.0);
    EXPECT_EQ(run.verdict().kind, VerdictKind::kNotChecked) << run.verdict().text;
    // The reference of a run that is reset follows the drive, here of P_1, which rises.
    run.change(run.plan(), run.chain().constants(), {{{0, {0.0, 0.5}}}, {}}, run.state());
    run.reset();
    run.advanceTo(9.0);
    EXPECT_LE(run.verdict().kind, VerdictKind::kInaccurate) << run.verdict().text;
  }
  State start = test::straightLine(7, -0.16, 0.12);
  start.x().tail(6).array() -= 0.024;  // a stretched first spring makes the chain buckle
  start.y().tail(6).array() += 0.018;
  const Chain chain(Eigen::VectorXd::Constant(7, 0.08), {4580.0, 2.76, 0.2}, 0.0);
  for (const auto& [method, step] :
       {std::pair{"Runge-Kutta-4", 0.0036}, {"Velocity-Verlet", 1e-3}}) {
    Scenario scenario = scenarioOf(method);
    scenario.time_step = step;
    const test::ProgramRun run = runAfter(scenario, {"", chain, start}, 3.0);
    EXPECT_GT(run.largestEnergyError(), 0.02);
    EXPECT_EQ(run.verdict().kind, VerdictKind::kSensitive) << run.verdict().text;
  }
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

// A light particle buckles at 2.8 s. At 7.2 s, errors of the start have grown 52 times, later ones 125.
TEST(Run, SaysFromWhenOnItExceedsTheTolerance) {
  const Eigen::Vector4d masses{1.0, 1.0, 1e-4, 1.0};
  const test::Scene scene{"", Chain(masses, {50.0, 1.0, 1.0}, 9.81),
                          test::straightLine(4, 1.0, 0.0)};
  Scenario scenario = scenarioOf("Auto");
  scenario.tolerance = 1e-3;
  test::ProgramRun run = runAfter(scenario, scene, 10.0);
  scenario.tolerance = 1e-4;
  run.change(scenario, scene.chain.constants(), {}, run.state());  // changes no earlier error
  EXPECT_THAT(run.toleranceRemark(), HasSubstr("exceeds ten times the tolerance from t = 7.2 s"));
}

test::Scene weaklyDamped() {
  const Eigen::VectorXd masses =
      (Eigen::VectorXd(9) << 0.55, 0.22, 0.22, 0.21, 0.49, 0.27, 0.11, 1.8, 0.68).finished();
  State start(9);
  start.x() << 0.0, 0.89, 0.35, -0.64, 0.15, -0.04, 0.15, 0.25, 0.80;
  start.y() << 0.0, 0.43, 1.21, 1.65, 2.11, 3.18, 4.10, 5.00, 5.82;
  return {"weakly damped", Chain(masses, {192.57, 0.5577, 1.0}, 9.81), start};
}

// Perturbations grow 1e7 times in 12 s. Errors are 100 to 3000 tolerances, uncertain by over ten.
TEST(Run, UncertaintyAboveTenTolerancesIsNotConcealed) {
  for (const Method& method : methodTable()) {
    if (method.hasFixedStep()) continue;
    Scenario scenario = scenarioOf(method.name);
    scenario.tolerance = 1e-10;
    const test::ProgramRun run = runAfter(scenario, weaklyDamped(), 12.0);
    EXPECT_THAT(run.toleranceRemark(), HasSubstr("sensitive from t = ")) << method.name;
    if (method.name != "Radau-9") continue;  // the uncertainty at the time of its largest error
    EXPECT_FALSE(run.positionError().isResolved());
    EXPECT_GE(run.positionError().bound, run.positionError().largest);
    EXPECT_THAT(run.measurements(), HasSubstr("largest position error below "));
  }
}

// Taylor-8 keeps the tolerance until 3.6 s. At 2.4 s, small changes have grown 38,000 times.
TEST(Run, SaysSinceWhenAnExceededToleranceCannotBeKept) {
  State start(4);
  start.x() << 0.0, 1.1336470738647415, -1.03941019290032, -2.283385984913633;
  start.y() << 0.0, 0.9657065224934605, 1.8022154567520603, -0.9497857525598479;
  start.vx() << 0.0, -2.1138212995421397, -0.5339702476725604, 0.9258682123760091;
  start.vy() << 0.0, -0.9997549557851332, 2.0139964083506903, 2.8972174982354235;
  const test::Scene scene{"", Chain(Eigen::VectorXd::Ones(4), {1000.0, 0.01, 2.5}, 0.0), start};
  Scenario scenario = scenarioOf("Stabilized-Taylor-8");
  scenario.tolerance = 1e-6;
  EXPECT_EQ(
      runAfter(scenario, scene, 7.0).toleranceRemark(),
      "the position error exceeds ten times the tolerance from t = 2.3 s on; sensitive from "
      "t = 2.4 s on: small errors grow so much that no method can promise a tolerance of 1e-06 m");
}

// A scale of the start alone would call an error of 1e-12 m large.
TEST(Run, ErrorsAreRelatedToTheLengthThatTheChainReaches) {
  State start(2);
  start.x()[1] = 1e-10;
  const test::Scene scene{"", Chain(Eigen::Vector2d::Ones(), {300.0, 1.0, 0.0}, 9.81), start};
  for (const std::string_view method : {"Auto", "Taylor-8", "Radau-9"}) {
    const test::ProgramRun run = runAfter(scenarioOf(method), scene, 10.0);
    EXPECT_EQ(run.verdict().text, "ok") << method;
    EXPECT_EQ(run.toleranceRemark(), "") << method;
    EXPECT_GT(run.positionError().largest, 1e-12) << method;
  }
  EXPECT_EQ(runAfter(scenarioOf("Velocity-Verlet"), scene, 1.0).verdict().kind,
            VerdictKind::kInaccurate);  // 0.07 mm where the chain is 37 mm long
  // An error of 11 mm is large for a chain that was 5 m long, although it stretches to 12 m.
  Scenario coarse = scenarioOf("Runge-Kutta-2");
  coarse.time_step = 0.015;
  const test::Scene soft = test::horizontalChain("soft", 6, 2.0, {50.0, 1.0, 0.0});
  EXPECT_EQ(runAfter(coarse, soft, 7.5).verdict().kind, VerdictKind::kInaccurate);
}

// Verdict, errors and remarks depend neither on the display rate nor on how often a run may stop.
TEST(Run, SaysTheSameForEveryNumberOfPartsOfAFrame) {
  std::set<VerdictKind> kinds;
  for (unsigned seed = 0; seed < 24; ++seed) {
    const test::Scene scene = test::chaoticScene(seed);
    Scenario scenario = scenarioOf(seed % 2 == 0 ? "Taylor-8" : "Runge-Kutta-4");
    scenario.frames = 13;
    scenario.frame_interval = 1.0;
    scenario.time_step = 1.0 / 1024.0;
    scenario.steps_per_frame = 1024;
    std::vector<std::string> said;
    for (const int parts : {1, 2, 4, 64}) {
      test::ProgramRun run(scenario, scene, {false, 1.0 / parts, [] { return false; }});
      while (run.advancePart()) continue;
      ASSERT_EQ(run.frame(), 12);
      const auto& [now, uncertainty, most, time, bound, until] = run.positionError();
      said.push_back(run.measurements() + run.verdict().text + run.toleranceRemark() +
                     fmt::format("{} {} {}", most, bound, until));
      kinds.insert(run.verdict().kind);
    }
    for (const std::string& other : said) EXPECT_EQ(other, said[0]) << scene.name;
  }
  EXPECT_TRUE(kinds.count(VerdictKind::kSensitive) == 1 && kinds.count(VerdictKind::kOk) == 1);
}

TEST(Run, LargeCoordinatesAreNotCalledSensitive) {
  test::Scene scene = horizontal();
  scene.start.x().array() += 2e12;
  Scenario scenario = scenarioOf("Runge-Kutta-4");
  const test::ProgramRun run = runAfter(scenario, scene, 1.0);
  EXPECT_EQ(run.verdict().kind, VerdictKind::kNotChecked);
  EXPECT_THAT(run.verdict().text, HasSubstr("positions are so large that their rounding errors"));
}

TEST(Run, StopsInsideTheReferenceRun) {
  Scenario scenario = scenarioOf("Runge-Kutta-4");
  scenario.reference = ReferenceUse::kAlways;
  scenario.time_step = 1000.0;
  scenario.steps_per_frame = 1;
  int asked = 0;
  test::ProgramRun run(scenario, horizontal(0.0), {false, 0.0, [&asked] { return ++asked == 4; }});
  EXPECT_FALSE(run.advance());
  EXPECT_TRUE(run.wasStopped());
  EXPECT_EQ(asked, 4);
}

class ReportedErrorOn : public testing::TestWithParam<test::KnownMotion> {};

INSTANTIATE_TEST_SUITE_P(
    Scenes, ReportedErrorOn,
    testing::Values(test::KnownMotion{"single_vertical", {1, 2, 5, 10, 20, 50}},
                    test::KnownMotion{"two_masses_45deg", {1, 2, 5, 10, 20, 50}},
                    test::KnownMotion{"horizontal_11", {1, 2, 5, 10, 20, 50}},
                    test::KnownMotion{"horizontal_1000", {1, 2}},
                    test::KnownMotion{"light_100", {1, 5}}, test::KnownMotion{"lighter_100", {1}}),
    testing::PrintToStringParamName());

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
