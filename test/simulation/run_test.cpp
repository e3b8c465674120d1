// The loop of a run: frames, parts of frames, stops, sleep, resets.
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/io/run_files.hpp>
#include <spring_pendulum/simulation/run.hpp>

#include <gtest/gtest.h>

#include <vector>

#include "support/program_run.hpp"
#include "support/temporary_folder.hpp"

namespace spring_pendulum {
namespace {

Scene scene() {
  return readParticleFile(PROJECT_DIR "/data/particle.txt");
}

Scenario scenarioOf(std::string_view method) {
  Scenario scenario;
  scenario.method = findMethod(method);
  scenario.frames = 8;
  return scenario;
}

/// The states at the frames.
std::vector<State::Matrix> frames(test::ProgramRun& run, bool in_between) {
  std::vector<State::Matrix> states{run.state().values()};
  while (!run.isOver()) {
    in_between ? run.advancePart() : run.advance();
    if (run.isAtFrame()) states.emplace_back(run.state().values());
  }
  return states;
}

TEST(Run, AChainThatMayFallAsleepIsShownFrameByFrame) {
  Scenario scenario = scenarioOf("Runge-Kutta-4");
  scenario.sleep = 1e-3;
  test::ProgramRun run(scenario, scene(), {false, 0.01});
  run.advancePart();
  EXPECT_EQ(run.frame(), 1);
}

TEST(Run, AFrameIsCutIntoWholeSteps) {
  test::ProgramRun run(scenarioOf("Runge-Kutta-4"), scene(), {false, 1.0 / 30.0});
  std::vector<double> times;
  for (int i = 0; i < 6; ++i) {
    const double next = run.nextTime();
    run.advancePart();
    EXPECT_EQ(run.time(), next);
    times.push_back(run.time());
  }
  // A frame of 10 steps in 3 parts of 3, 3 and 4.
  const std::vector<double> expected{3 * 0.01,  6 * 0.01,  10 * 0.01,
                                     13 * 0.01, 16 * 0.01, 20 * 0.01};
  EXPECT_EQ(times, expected);
  EXPECT_EQ(run.frame(), 2);
}

TEST(Run, ToleranceOfAFixedStepMethodIsNotUsed) {
  Scenario scenario = scenarioOf("Euler");
  scenario.tolerance = 1e-300;
  EXPECT_EQ(test::ProgramRun(scenario, scene()).frame(), 0);
  scenario.method = findMethod("Auto");
  EXPECT_THROW(test::ProgramRun(scenario, scene()), InputError);
}

TEST(Run, NeverCutsFinerThanAStep) {
  test::ProgramRun run(scenarioOf("Euler"), scene(), {false, 1e-9});
  run.advancePart();
  EXPECT_EQ(run.time(), 0.01);
  EXPECT_FALSE(run.isAtFrame());
}

TEST(Run, ShowsALongFrameInSmallParts) {
  Scenario scenario = scenarioOf("Auto");
  scenario.frame_interval = 1000.0;
  test::ProgramRun run(scenario, scene(), {false, 1.0 / 30.0});
  EXPECT_LE(run.nextTime(), 1.0 / 30.0);
}

TEST(Run, ResetGivesTheSameRunAgain) {
  test::ProgramRun run(scenarioOf("Runge-Kutta-2"), scene(), {true, 0.05});
  const auto first = frames(run, true);
  const double dissipated = run.energyEntry().dissipated.value();
  EXPECT_GT(dissipated, 0.0);
  EXPECT_GT(run.positionError().largest, 0.0);
  run.reset();
  EXPECT_EQ(run.time(), 0.0);
  EXPECT_EQ(run.verdict().kind, VerdictKind::kOk);
  EXPECT_EQ(run.positionError().largest, 0.0);
  EXPECT_EQ(run.energyEntry().dissipated.value(), 0.0);
  EXPECT_TRUE(frames(run, false) == first);
  EXPECT_EQ(run.energyEntry().dissipated.value(), dissipated);
}

TEST(Run, MeasuresThePositionErrorAlsoBetweenFrames) {
  Scenario scenario = scenarioOf("Euler");
  test::ProgramRun plain(scenario, scene(), {true, 0.0}), shown(scenario, scene(), {true, 0.02});
  frames(plain, false);
  shown.advancePart();
  ASSERT_FALSE(shown.isAtFrame());
  EXPECT_GT(shown.positionError().now, 0.0);
  EXPECT_EQ(shown.positionError().largest, 0.0);  // of frame 0
  ASSERT_NE(shown.referenceState(), nullptr);
  frames(shown, true);
  EXPECT_GT(shown.positionError().largest, 1e-3);
  EXPECT_EQ(shown.positionError().largest, plain.positionError().largest);
  EXPECT_EQ(shown.verdict().kind, plain.verdict().kind);
  const State truth = *shown.referenceState();
  const auto view = shown.state().values().row(1);  // must stay valid
  shown.goTo(0, *shown.referenceState());           // belongs to what this replaces
  EXPECT_EQ(shown.state().values(), truth.values());
  EXPECT_EQ(view.data(), shown.state().values().row(1).data());
  scenario.reference = ReferenceUse::kNever;
  const test::ProgramRun unmeasured(scenario, scene(), {true, 0.0});
  EXPECT_EQ(unmeasured.referenceState(), nullptr);
  EXPECT_EQ(unmeasured.verdict().kind, VerdictKind::kNotChecked);
  EXPECT_NE(unmeasured.measurements().find("position error not measured"), std::string::npos);
}

TEST(Run, EndsWhereTheMotionDiverges) {
  Scenario scenario = scenarioOf("Euler");
  scenario.frames = 500;
  const Scene particles = readParticleFile(PROJECT_DIR "/data/horizontal_11.txt");
  test::ProgramRun run(scenario, particles, {false, 0.0});
  while (run.advance()) continue;
  EXPECT_FALSE(run.isShown());
  EXPECT_LT(run.frame(), 499);
  scenario.on_divergence = OnDivergence::kContinue;
  test::ProgramRun continued(scenario, particles, {false, 0.0});
  while (continued.advance()) continue;
  EXPECT_GT(continued.frame(), run.frame());
  EXPECT_EQ(continued.verdict().kind, VerdictKind::kDiverged);
  const std::string text = continued.measurements();  // also of frames after the divergence
  EXPECT_GT(std::stod(text.substr(text.find("energy error ") + 13)), 1e3) << text;
}

TEST(Run, ADivergedFrameNeedsNoReference) {
  Scenario scenario = scenarioOf("Runge-Kutta-4");
  scenario.reference = ReferenceUse::kAlways;
  scenario.time_step = 1e160;
  int asked = 0;
  test::ProgramRun run(scenario, scene(), {false, 0.0, [&asked] { return ++asked > 1000; }});
  EXPECT_FALSE(run.advance() && run.advance());
  EXPECT_EQ(run.verdict().kind, VerdictKind::kDiverged);
}

/// Stops when asked for the n-th time.
RunOptions stoppingAt(int& asked, int last) {
  return {false, 0.0, [&asked, last] { return ++asked >= last; }};
}

TEST(Run, StopsInsideALongFrameWithEveryMethod) {
  for (const Method& method : methodTable()) {
    Scenario scenario = scenarioOf(method.name);
    scenario.steps_per_frame = std::int64_t{1} << 50U;
    scenario.frame_interval = 1e6;
    scenario.reference = ReferenceUse::kNever;
    const TemporaryFolder folder;
    scenario.output = folder.path("frames");
    int asked = 0;
    test::ProgramRun run(scenario, scene(), stoppingAt(asked, 3));
    RunFiles files(run, scenario);
    EXPECT_FALSE(run.advance()) << method.name;
    files.write(run);
    files.finish();
    EXPECT_TRUE(listFolder(scenario.output).empty()) << method.name;
    EXPECT_TRUE(run.wasStopped()) << method.name;
    EXPECT_TRUE(run.isOver()) << method.name;
    EXPECT_EQ(run.frame(), 0) << method.name;
    EXPECT_FALSE(run.advance()) << method.name;
    EXPECT_EQ(asked, 3) << method.name;
  }
}

TEST(Run, AskingWhetherToStopLeavesTheBitsOfTheFramesForEveryMethod) {
  for (const Method& method : methodTable()) {
    SCOPED_TRACE(method.name);
    Scenario scenario = scenarioOf(method.name);
    scenario.frames = 3;
    scenario.steps_per_frame = 450'000;
    scenario.time_step = 1e-4;
    scenario.frame_interval = 20.0;
    scenario.reference = ReferenceUse::kNever;
    int asked = 0;
    test::ProgramRun run(scenario, scene(), stoppingAt(asked, 1'000'000));
    const auto integrator = makeIntegrator(method, run.chain());
    State state = run.start();
    while (run.advance()) integrator->advance(state, scenario.step(), scenario.steps());
    EXPECT_TRUE(run.state().values() == state.values());
    EXPECT_GE(asked, method.hasFixedStep() ? 4 : 2);
  }
}

Scene hanging(double below) {
  const Chain chain(Eigen::VectorXd::Ones(3), SpringLaw{}, 9.81);
  Scene particles{chain.masses(), test::hangingAtRest(chain)};
  particles.state.y()[2] -= below;
  return particles;
}

TEST(Run, SkipsTheStepsOfAChainAtRestOnlyOnRequest) {
  Scenario scenario;
  scenario.frames = 10;
  test::ProgramRun awake(scenario, hanging(0.0));
  awake.advance();
  EXPECT_EQ(awake.integrator().forceEvaluations(), 40);
  scenario.sleep = 1e-9;
  test::ProgramRun asleep(scenario, hanging(0.0));
  while (asleep.advance()) continue;
  EXPECT_EQ(asleep.integrator().forceEvaluations(), 0);
  EXPECT_TRUE(asleep.state().values() == asleep.start().values());
  EXPECT_NE(asleep.closingLine().find("(9 at rest, not integrated)"), std::string::npos);
}

// Measured: asleep in 2248 frames of 3000, 3.8e-9 m from where it would have gone.
TEST(Run, FallsAsleepCloseToWhereTheChainWouldHaveComeToRest) {
  Scenario scenario;
  scenario.frames = 3001;
  test::ProgramRun awake(scenario, hanging(0.5), {true});
  scenario.sleep = 1e-6;
  test::ProgramRun run(scenario, hanging(0.5), {true});
  while (awake.advance() && run.advance()) continue;
  EXPECT_NEAR(static_cast<double>(run.integrator().forceEvaluations()), 40 * 752, 40 * 20);
  EXPECT_LT((run.state().positions() - awake.state().positions()).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(run.energyEntry().dissipated.value(), awake.energyEntry().dissipated.value(), 1e-6);
  EXPECT_EQ(run.verdict().kind, VerdictKind::kOk);
}

/// Whether a run stays asleep from this start on.
bool sleeps(const Scene& scene, double tolerance) {
  Scenario scenario;
  scenario.sleep = tolerance;
  scenario.frames = 2;
  test::ProgramRun run(scenario, scene);
  run.advance();
  return run.integrator().forceEvaluations() == 0;
}

TEST(Run, SleepsOnlyWhereNothingMovesAndNothingTurns) {
  Scene moving = hanging(0.0);
  moving.state.vx()[2] = 2e-9;
  EXPECT_FALSE(sleeps(moving, 1e-9));
  const Scene turning = hanging(1e-7);  // without speed: 50 N/m give 5e-6 m/s in 1 s
  EXPECT_FALSE(sleeps(turning, 1e-6));
  EXPECT_TRUE(sleeps(turning, 1e-5));
}

}  // namespace
}  // namespace spring_pendulum
