#include "sweep/study/study.hpp"

#include "sweep/sweep_run.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "support/temporary_folder.hpp"

namespace spring_pendulum::sweep {
namespace {

constexpr const char* kParticles = "0 0 1\n1 0 1\n2 0 3\n";

Study studyOf(const TemporaryFolder& folder, const std::string& text) {
  folder.write("particle.txt", kParticles);
  return readStudy(folder.write("study.yaml", text));
}

TEST(Study, LastAxisVariesFastestAndSamplesSlowest) {
  const TemporaryFolder folder;
  const Study study = studyOf(folder,
                              "axes:\n  method: [Euler, Auto]\n  stiffness: {linear: [10, 30, 3]}\n"
                              "  damping: {list: [1, 2, 3], with: stiffness}\n"
                              "random: {samples: 2, displacement: {normal: [0, 0.01]}}\n");
  ASSERT_EQ(study.cases(), 12);
  const Case made = caseOf(study, 4);
  EXPECT_EQ(made.settings.scenario.constants.spring.damping, 2.0);
  EXPECT_EQ(made.settings.scenario.method.get().name, "Auto");
  EXPECT_EQ(made.settings.scenario.constants.spring.stiffness, 20.0);
  EXPECT_EQ(made.sample, 0);
  EXPECT_EQ(caseOf(study, 6).sample, 1);
  EXPECT_EQ(caseOf(study, 6).settings.scenario.method.get().name, "Euler");
}

TEST(Study, CasesOfOneSampleHaveTheSameParticles) {
  const TemporaryFolder folder;
  const Study study =
      studyOf(folder,
              "axes:\n  method: all\n"
              "random:\n  seed: 3\n  samples: 5\n  mass_factor: {log_normal: [1, 0.2]}\n"
              "  velocity: {uniform: [-1, 1]}\n");
  const std::int64_t methods = study.cases() / 5;
  const Scene of_first = caseOf(study, 0).particles;
  EXPECT_EQ(caseOf(study, methods - 1).particles.masses.view(), of_first.masses.view());
  EXPECT_EQ(caseOf(study, methods - 1).particles.state.values(), of_first.state.values());
  EXPECT_NE(caseOf(study, methods).particles.masses[1], of_first.masses[1]);
  EXPECT_NE(of_first.masses[1], 1.0);
  EXPECT_NE(of_first.state.vx()[1], 0.0);
  EXPECT_EQ(of_first.state.vx()[0], 0.0);
}

TEST(Study, DurationGivesFramesAndSteps) {
  const TemporaryFolder folder;
  const Study study = studyOf(folder,
                              "base: {duration: 2}\naxes:\n  method: [Euler, Auto]\n"
                              "  time_step: [0.01, 0.025, 0.5, 2]\n");
  const std::int64_t expected[][2] = {{21, 10}, {21, 4}, {5, 1}, {2, 1}};
  for (std::int64_t i = 0; i < 4; ++i) {
    const Scenario scenario = caseOf(study, i).settings.scenario;
    EXPECT_EQ(scenario.frames, expected[i][0]) << i;
    EXPECT_EQ(scenario.steps_per_frame, expected[i][1]) << i;
  }
  EXPECT_EQ(caseOf(study, 7).settings.scenario.frames, 21);
  const Study steps = studyOf(folder,
                              "base: {duration: 1}\naxes:\n  method: [Runge-Kutta-4, Auto]\n"
                              "  time_step: {log: [0.0003, 0.1, 9]}\n");
  for (std::int64_t i = 0; i < steps.cases(); ++i) {
    const Scenario scenario = caseOf(steps, i).settings.scenario;
    EXPECT_NEAR(scenario.timeOfFrame(scenario.frames - 1), 1.0, 1e-12) << i;
  }
}

TEST(Study, OptionsThatSomeCaseUsesAreAccepted) {
  const TemporaryFolder folder;
  for (const char* const text :
       {"base: {frame_interval: 1, duration: 2}\n",
        "base: {frame_interval: 1}\naxes: {duration: [1, 2]}\n",
        "base: {frame_interval: 1, time_step: 1}\naxes: {method: all}\n"}) {
    EXPECT_NO_THROW(studyOf(folder, text)) << text;
  }
}

TEST(Study, HashDependsOnTheParticles) {
  const TemporaryFolder folder;
  const std::uint64_t hash = studyOf(folder, "axes: {method: all}\n").hash;
  EXPECT_EQ(studyOf(folder, "axes: {method: all}\n").hash, hash);
  EXPECT_NE(studyOf(folder, "axes: {method: all }\n").hash, hash);
  folder.write("particle.txt", "0 0 1\n1 0 1\n");
  EXPECT_NE(readStudy(folder.path("study.yaml")).hash, hash);
  folder.write("b.txt", "3 0 1\n4 0 1\n");
  const char* const two = "axes: {particles: [particle.txt, b.txt]}\n";
  const std::uint64_t hash_of_two = studyOf(folder, two).hash;
  folder.write("particle.txt", "0 0 1\n");  // a line moves from one file to the next
  folder.write("b.txt", "1 0 1\n3 0 1\n4 0 1\n");
  EXPECT_NE(studyOf(folder, two).hash, hash_of_two);
}

TEST(Study, ShippedStudiesAreValid) {
  const TemporaryFolder folder;  // ".." after a link is not where the link is
  std::filesystem::create_directory_symlink(PROJECT_DIR "/config/studies", folder.path("linked"));
  EXPECT_NO_THROW(readStudy(folder.path("linked/order.yaml")));
  int studies = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PROJECT_DIR "/config/studies")) {
    const Study study = readStudy(entry.path().string());
    EXPECT_FALSE(study.plot.empty()) << entry.path();
    EXPECT_NO_THROW(checkCases(study, 1)) << entry.path();
    for (const Axis& axis : study.axes) {
      const std::set<std::string> different(axis.values.begin(), axis.values.end());
      EXPECT_EQ(different.size(), axis.values.size()) << entry.path() << axis.key;
    }
    ++studies;
  }
  EXPECT_EQ(studies, 4);
}

TEST(Study, BadInputIsFoundBeforeTheFirstCase) {
  const std::pair<const char*, const char*> bad[] = {
      {"", ":1: study: must be lines 'key: value'"},
      {"[1, 2]\n", "study: must be lines 'key: value'"},
      {"bass: {}\n", "unknown key 'bass'; did you mean 'base'?"},
      {"base: {time_step: 0}\n", ":1: time_step: must be a number above 0 s, got '0'"},
      {"base: {time_step: '0.1'}\n", "single value without quotes"},
      {"base: {output: here}\n", "unknown key 'output'"},
      {"base: {time_step: 1, time_step: 2}\n", "time_step: is given twice"},
      {"base: {particles: none.txt}\n", "none.txt: could not be read"},
      {"base: {duration: 1, frames: 2}\n", "duration sets frames"},
      {"base: {frame_interval: 1}\n",
       ":1: frame_interval: Runge-Kutta-4 takes fixed steps; use time_step and steps_per_frame"},
      {"axes: {method: fixed-step, frame_interval: [1, 2]}\n", "frame_interval: Euler takes fixed"},
      {"base: {tolerance: 1}\naxes: {method: [Euler]}\n", ":1: tolerance: Euler takes fixed steps"},
      {"base: {time_step: 1}\naxes: {method: [Auto, Radau-9]}\n",
       ":1: time_step: Auto chooses its own steps; use tolerance and frame_interval"},
      {"axes: {time_step: []}\n", "must be a list with at least one value"},
      {"axes: {time_step: [0.1, x]}\n", "got 'x'"},
      {"axes: {time_step: {log: [0, 1, 3]}}\n", "must be above 0"},
      {"axes: {time_step: {linear: [1, 2, 1]}}\n", "must be a whole number from 2"},
      {"base: {duration: 5}\naxes: {time_step: {linear: [-0.003, 0.1, 12]}}\n", "got '-0.003'"},
      {"axes: {time_step: {}}\n", "must be {list: ...}, {linear: ...} or {log: ...}"},
      {"axes: {method: some}\n", "must be a list, all, fixed-step or error-controlled"},
      {"axes: {method: [Oiler]}\n", "did you mean 'Euler'?"},
      {"axes: {damping: [1, 2], time_step: {list: [1], with: damping}}\n", "as many values as"},
      {"axes: {damping: [1, 2], time_step: {list: [1], with: method}}\n", "key of the axis before"},
      {"random: {seed: 1}\n", "samples is missing"},
      {"random: {samples: 1, mass_factor: {normal: [1, 1]}}\n", "positive values only"},
      {"random: {samples: 1, displacement: {uniform: [nan, 1]}}\n", "got 'nan'"},
      {"columns: [verdikt]\n", "did you mean 'verdict'?"},
      {"plot: {tipe: map}\n", "unknown key 'tipe'"},
      {"a: &x 1\nb: *x\n", "must not use aliases"},
      {"[[[[[[[[1]]]]]]]]\n", "is nested too deeply"},
      {"base: 'x\n", "a quotation mark is not closed"},
      {"axes: {damping: {linear: [0, 1, 99999]}, gravity: {linear: [0, 1, 99999]}}\n", "1e9 cases"},
      // These depend on several values, so each case is tried.
      {"axes: {frames: [10, 9000000000000000000]}\n", "case 1: frames times steps_per_frame"},
      {"base: {method: Auto}\naxes: {tolerance: [1e-6, 1e-30]}\n", "case 1: tolerance: must be at"},
      {"axes: {mass_factor: [1, 1e308]}\n", "case 1: particle 3: mass must be positive and finite"},
      {"axes: {gravity: [1, 1e308]}\n", "case 1: the initial energy exceeds"},
      {"base: {start: at_rest}\nrandom: {samples: 1, velocity: {normal: [0, 1]}}\n", "start: at"},
      {"base: {duration: 1}\naxes: {time_step: [0.1, 0.3]}\n", "case 1: time_step: whole steps"},
  };
  const TemporaryFolder folder;
  for (const auto& [text, message] : bad) {
    try {
      checkCases(studyOf(folder, text), 2);
      ADD_FAILURE() << text << " is accepted";
    } catch (const std::exception& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(message)) << text;
      EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("\n"))) << text;
    }
  }
}

}  // namespace
}  // namespace spring_pendulum::sweep
