// Options that say how a run is computed and shown change no bit of its frames and not its verdict,
// whatever their combination: threads, energy, states between frames, sleep, reset, frame interval.
#include "integration/fixed_step/plain_runge_kutta.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "support/program_run.hpp"
#include "support/random_scenes.hpp"

namespace spring_pendulum {
namespace {

constexpr std::int64_t kFrames = 6;
constexpr std::int64_t kSteps = 24;  // per frame

Scenario scenarioOf(const Method& method, const test::Scene& scene) {
  Scenario scenario;
  scenario.method = method;
  scenario.frames = kFrames;
  scenario.steps_per_frame = kSteps;
  scenario.time_step = 2e-3;
  scenario.frame_interval = 0.05;
  scenario.tolerance = 1e-4;
  scenario.threads = 1;
  return test::scenarioFor(scene, scenario);
}

/// The simplest program: one call of `advance` per frame, and the plain code where there is one.
std::vector<State> framesOfThePlainProgram(const Scenario& scenario, const test::Scene& scene) {
  const Method& method = scenario.method;
  std::unique_ptr<Integrator> integrator;
  if (method.hasFixedStep() && method.tableau != nullptr)
    integrator = std::make_unique<PlainRungeKutta>(scene.chain, *method.tableau, false);
  else
    integrator = makeIntegrator(method, scene.chain, {scenario.tolerance, false, 1});
  std::vector<State> frames{scene.start};
  for (std::int64_t i = 1; i < scenario.frames; ++i) {
    frames.push_back(frames.back());
    integrator->advance(frames.back(), scenario.step(), scenario.steps());
  }
  return frames;
}

/// What a user sees of a run.
struct Outcome {
  std::vector<State> frames;       ///< those that are shown
  std::vector<double> dissipated;  ///< J, at these frames; empty if not tracked
  std::string verdict;
  std::string measurements;
  std::string remark;
};

Outcome outcomeOf(test::ProgramRun& run, std::mt19937& random) {
  Outcome outcome;
  for (;;) {
    if (run.isAtFrame() && run.isShown()) {
      outcome.frames.push_back(run.state());
      const auto dissipated = run.energyEntry().dissipated;
      if (dissipated) outcome.dissipated.push_back(*dissipated);
    }
    if (run.isOver()) break;
    random() % 4 != 0 ? run.advancePart() : run.advance();
  }
  outcome.verdict = run.verdict().text;
  outcome.measurements = run.measurements();
  outcome.remark = run.toleranceRemark();
  return outcome;
}

bool sameBits(const State& a, const State& b) {
  const auto bytes = static_cast<std::size_t>(a.values().size()) * sizeof(double);
  return std::memcmp(a.values().data(), b.values().data(), bytes) == 0;
}

/// \param every compares frame n with the expected frame n / every
void expectSameFrames(const std::vector<State>& frames, const std::vector<State>& expected,
                      std::size_t every) {
  for (std::size_t i = 0; i < frames.size() && i / every < expected.size(); i += every)
    EXPECT_TRUE(sameBits(frames[i], expected[i / every])) << "frame " << i;
}

/// A random combination of options.
struct Options {
  explicit Options(std::mt19937& random)
      : threads(static_cast<std::int64_t>(random() % 4)),
        track_dissipation(random() % 2 == 0),
        display_interval(static_cast<double>(random() % 5) * 0.007),
        sleep(random() % 2 == 0 ? 0.0 : 1e-300),
        reset_after(static_cast<int>(random() % 8)) {}

  std::int64_t threads;
  bool track_dissipation;
  double display_interval;
  double sleep;
  int reset_after;  ///< calls of `advance`
};

TEST(RandomOptions, ChangeNoBitAndNoVerdict) {
  unsigned first = 3000;
  for (const Method& method : methodTable()) {
    ++first;  // the methods share the families of scenes
    for (unsigned seed = first; seed < first + 30; seed += 3) {
      const test::Scene scene = test::randomScene(seed);
      const Scene particles{scene.chain.masses(), scene.start};
      Scenario scenario = scenarioOf(method, scene);
      SCOPED_TRACE(std::string(method.name) + ", " + scene.name);
      std::mt19937 random(seed);
      test::ProgramRun plain(scenario, particles, {false, 0.0});
      const Outcome expected = outcomeOf(plain, random);
      expectSameFrames(expected.frames, framesOfThePlainProgram(scenario, scene), 1);

      const Options options(random);
      scenario.threads = options.threads;
      scenario.sleep = options.sleep;
      test::ProgramRun run(scenario, particles,
                           {options.track_dissipation, options.display_interval});
      for (int i = 0; i < options.reset_after && !run.isOver(); ++i) run.advancePart();
      run.reset();
      const Outcome outcome = outcomeOf(run, random);
      EXPECT_EQ(outcome.frames.size(), expected.frames.size());
      expectSameFrames(outcome.frames, expected.frames, 1);
      EXPECT_EQ(outcome.verdict, expected.verdict);
      EXPECT_EQ(outcome.remark, expected.remark);
      if (outcome.dissipated.size() == expected.dissipated.size()) {  // else it would cost too much
        EXPECT_EQ(outcome.dissipated, expected.dissipated);
        EXPECT_EQ(outcome.measurements, expected.measurements);
      }

      scenario.frames = 4 * (kFrames - 1) + 1;
      scenario.frame_interval /= 4.0;
      scenario.steps_per_frame /= 4;
      test::ProgramRun finer(scenario, particles,
                             {options.track_dissipation, options.display_interval});
      expectSameFrames(outcomeOf(finer, random).frames, expected.frames, 4);
    }
  }
}

}  // namespace
}  // namespace spring_pendulum
