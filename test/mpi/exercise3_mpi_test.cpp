// Exercise3_mpi on real ranks: the same bytes as Exercise3, and one line for everything that is refused.
#include <spring_pendulum/integration/method_table.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A chain with random masses and springs.
std::string irregularChain(int particles) {
  std::mt19937 random(7);
  const auto next = [&random] { return 1e-9 * static_cast<double>(random() % 1'000'000'000U); };
  std::string text = "# irregular\n";
  double x = 0.0;
  for (int i = 0; i < particles; ++i, x += 0.7 + 0.6 * next()) {
    text += fmt::format("{:.9f} {:.9f} {:.9f}\n{}", x, next(), 0.5 + next(),
                        i % 5 == 0 ? "\n# a comment\n" : "");
  }
  return text;
}

class Exercise3Mpi : public testing::Test {
 protected:
  Exercise3Mpi() { folder_.write("particle.txt", irregularChain(1000)); }

  Result serial(const std::vector<std::string>& options) const {
    return run(exercise3(folder_, options));
  }

  /// \param ranks 0: one process without mpirun
  Command command(int ranks, const std::vector<std::string>& options,
                  const std::string& program = EXERCISE3_MPI) const {
    Command command{{program}, folder_.path(), {}, {}};
    if (ranks > 0) command.arguments = {MPIEXEC, "-n", std::to_string(ranks), program};
    command.arguments.insert(command.arguments.end(), options.begin(), options.end());
    // Tests run as root, with more ranks than cores.
    command.environment = {{"OMPI_ALLOW_RUN_AS_ROOT", "1"},
                           {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"},
                           {"OMPI_MCA_rmaps_base_oversubscribe", "1"},
                           {"OMPI_MCA_mpi_yield_when_idle", "1"}};
    return command;
  }
  Result shared(int ranks, const std::vector<std::string>& options) const {
    return run(command(ranks, options));
  }

  std::string read(const std::string& name) const { return readFile(folder_.path(name)); }

  void expectSameFrames(const std::string& expected, const std::string& actual) const {
    const std::vector<std::string> frames = listFolder(folder_.path(expected));
    ASSERT_EQ(listFolder(folder_.path(actual)), frames);
    for (const std::string& frame : frames) {
      const auto in = [&](const std::string& name) {
        return read(fmt::format("{}/{}", name, frame));
      };
      EXPECT_TRUE(in(expected) == in(actual)) << frame;
    }
  }

  /// Expects one line of ours; mpirun adds lines on the exit status.
  void expectRefused(int ranks, const std::vector<std::string>& options, int status,
                     const std::string& message) const {
    const Result result = shared(ranks, options);
    EXPECT_EQ(result.status, status) << result.errors;
    EXPECT_THAT(result.errors, StartsWith(message));
    EXPECT_THAT(result.errors.substr(message.size()), Not(HasSubstr(message)));
    EXPECT_EQ(result.output, "");
  }

  TemporaryFolder folder_;
};

TEST_F(Exercise3Mpi, WritesTheBytesOfExercise3) {
  int ranks = 0;
  for (const Method& method : methodTable()) {
    if (!method.hasFixedStep()) continue;
    for (const std::string damping : {"0", "1"}) {
      const auto options = [&](const std::string& name) -> std::vector<std::string> {
        return {method.name,
                "--frames",
                "6",
                "--damping",
                damping,
                "--time-step",
                "1e-3",
                "--output",
                name,
                "--energy",
                name + ".csv",
                "--save-state",
                name + "_state.txt",
                "--reference",
                "never"};
      };
      ranks = ranks % 4 + 1;
      SCOPED_TRACE(fmt::format("{} with damping {} on {} ranks", method.name, damping, ranks));
      ASSERT_EQ(serial(options("serial")).status, 0);
      ASSERT_EQ(shared(ranks, options("shared")).status, 0);
      expectSameFrames("serial", "shared");
      EXPECT_EQ(read("serial.csv"), read("shared.csv"));
      EXPECT_TRUE(read("serial_state.txt") == read("shared_state.txt"));
    }
  }
}

TEST_F(Exercise3Mpi, SharesALongChain) {
  folder_.write("particle.txt", irregularChain(100'003));
  ASSERT_EQ(serial({"Runge-Kutta-4", "--frames", "3", "-o", "serial"}).status, 0);
  for (const int ranks : {2, 3}) {
    ASSERT_EQ(shared(ranks, {"Runge-Kutta-4", "--frames", "3", "-o", "shared"}).status, 0);
    expectSameFrames("serial", "shared");
  }
}

TEST_F(Exercise3Mpi, GoesOnWithAnyNumberOfRanks) {
  ASSERT_EQ(serial({"Runge-Kutta-4", "-o", "whole", "--frames", "8"}).status, 0);
  ASSERT_EQ(
      shared(3, {"Runge-Kutta-4", "-o", "parts", "--frames", "4", "--save-state", "a.txt"}).status,
      0);
  ASSERT_EQ(shared(2, {"Runge-Kutta-4", "a.txt", "--resume", "-o", "parts", "--frames", "6",
                       "--save-state", "b.txt"})
                .status,
            0);
  ASSERT_EQ(serial({"Runge-Kutta-4", "b.txt", "--resume", "-o", "parts", "--frames", "8"}).status,
            0);
  expectSameFrames("whole", "parts");
}

TEST_F(Exercise3Mpi, ADivergenceEndsBothAlike) {
  const std::vector<std::string> options{"Euler",     "--frames", "50", "--time-step", "0.05",
                                         "--damping", "0",        "-o", "serial"};
  EXPECT_EQ(serial(options).status, 3);
  std::vector<std::string> same = options;
  same.back() = "shared";
  const Result result = shared(3, same);
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.errors, HasSubstr("diverged at t = "));
  EXPECT_GT(listFolder(folder_.path("serial")).size(), 2u);
  expectSameFrames("serial", "shared");
}

TEST_F(Exercise3Mpi, RefusesWhatItCannotDo) {
  for (const std::string method : {"Auto", "Radau-9", "Taylor-8", "Dormand-Prince-5"}) {
    expectRefused(0, {method}, 2,
                  method +
                      ": chooses its own steps; Exercise3_mpi needs a method with a fixed "
                      "step\n");
  }
  expectRefused(0, {"Euler", "--sleep", "1"}, 2,
                "--sleep: not with Exercise3_mpi; use Exercise3\n");
  expectRefused(0, {"Euler", "--check"}, 2, "--check: not with Exercise3_mpi; use Exercise3\n");
  expectRefused(0, {"Euler", "--reference", "always"}, 2, "--reference always: not with ");
  expectRefused(2, {"Euler", "--time-stp", "1"}, 2, "unknown option '--time-stp'");
  expectRefused(
      2, {"Euler", "--steps-per-frame", "500"}, 2,
      "1000 particles on 2 ranks leave a rank 512, but each needs 1002, twice the steps per "
      "frame times the stages of Euler; use fewer ranks or fewer steps_per_frame\n");
  expectRefused(2, {"Runge-Kutta-4", "--steps-per-frame", "9000000000000000000", "--frames", "1"},
                2, "1000 particles on 2 ranks leave a rank 512, but each needs 8010");
  expectRefused(2, {"Euler", "none.txt"}, 1,
                folder_.path("none.txt") + ": could not be read: No such file or directory\n");
  expectRefused(2, {"Euler", "-o", "particle.txt"}, 1,
                folder_.path("particle.txt") + ": could not");
}

TEST_F(Exercise3Mpi, NamesTheLineOfBadInputLikeExercise3) {
  const std::string good = irregularChain(1000);
  const std::size_t middle = good.find('\n', good.size() / 2) + 1;
  const std::size_t end = good.find('\n', middle) + 1;
  const std::string texts[] = {
      "",
      "# nothing\n",
      good.substr(0, middle) + "1 2 x\n" + good.substr(middle),
      good + "1 2 3 4 5\n",
      good.substr(0, middle) + "1 2 -1\n" + good.substr(end),
      good.substr(0, middle) + good.substr(middle, end - middle) + good.substr(middle)};
  int ranks = 0;  // starting a job takes longer than the run
  for (const std::string& text : texts) {
    folder_.write("particle.txt", text);
    const Result expected = serial({"Euler", "--no-frames"});
    EXPECT_EQ(expected.status, 2);
    expectRefused(ranks, {"Euler", "--no-frames"}, 2, expected.errors);
    ranks = ranks == 0 ? 2 : 5 - ranks;
  }
}

TEST_F(Exercise3Mpi, FullDiskIsOneLine) {
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"Euler", "-o", "full"},
        {"Euler", "--no-frames", "--frames", "2", "--save-state", "full/state.txt"}}) {
    Command limited = command(2, options);
    const auto program = limited.arguments.begin() + 3;
    limited.arguments.insert(program, {"prlimit", "--fsize=3000"});
    const Result result = run(limited);
    EXPECT_EQ(result.status, 1) << result.errors;
    const std::string message = "could not be written: File too large\n";
    EXPECT_THAT(result.errors, HasSubstr(message));
    EXPECT_EQ(result.errors.find(message), result.errors.rfind(message)) << result.errors;
    for (const std::string& name : listFolder(folder_.path("full"))) {
      EXPECT_EQ(name.find("frame_"), std::string::npos) << name;
    }
  }
}

TEST_F(Exercise3Mpi, AKilledRankEndsTheJob) {
  ASSERT_EQ(serial({"Runge-Kutta-4", "-o", "serial", "--frames", "4"}).status, 0);
  std::string script;
  for (const std::string& word :
       command(3, {"Runge-Kutta-4", "-o", "shared", "--frames", "1000000"}).arguments) {
    script += " '" + word + "'";
  }
  script +=
      " & job=$!; until [ -e shared/frame_0003.txt ]; do sleep 0.02; done; "
      "kill -9 $(ps -o pid= --ppid $job | tail -n 1); wait $job";
  Command killed = command(3, {});
  killed.arguments = {"bash", "-c", script};
  EXPECT_NE(run(killed).status, 0);
  for (const std::string& frame : listFolder(folder_.path("shared"))) {
    if (frame.front() == '.') continue;  // the frame that was being written, under a hidden name
    const std::string text = read("shared/" + frame);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1000) << frame;
    if (frame > "frame_0003.txt") continue;
    EXPECT_TRUE(text == read("serial/" + frame)) << frame;
  }
}

// The frame would take hours.
TEST_F(Exercise3Mpi, ASignalEndsALongFrame) {
  Command ended = command(0, {});
  ended.arguments = {"bash", "-c",
                     fmt::format("'{}' Runge-Kutta-4 -o long --steps-per-frame 2000000000 "
                                 "--time-step 1e-4 --save-state state.txt & job=$!; "
                                 "until [ -e long/frame_0000.txt ]; do sleep 0.02; done; "
                                 "kill $job; wait $job",
                                 EXERCISE3_MPI)};
  const Result result = run(ended);
  EXPECT_EQ(result.status, 143) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("1 frame, 0 steps,"));
  EXPECT_EQ(listFolder(folder_.path("long")), std::vector<std::string>{"frame_0000.txt"});
  EXPECT_THAT(read("state.txt"), HasSubstr("frame 0"));
}

TEST_F(Exercise3Mpi, Exercise3IsNotStartedSeveralTimes) {
  const Result result = run(command(2, {"Euler", "-o", "shared"}, EXERCISE3));
  EXPECT_EQ(result.status, 2);
  const std::string message =
      "this is one of 2 processes (OMPI_COMM_WORLD_SIZE), which would write the same files; start "
      "Exercise3 without mpirun, or use Exercise3_mpi\n";
  EXPECT_THAT(result.errors, HasSubstr(message));
  EXPECT_FALSE(std::filesystem::exists(folder_.path("shared")));
  Command other = exercise3(folder_, {"Euler", "-o", "shared"});
  other.environment["PMI_SIZE"] = "4";
  EXPECT_THAT(run(other).errors, StartsWith("this is one of 4 processes (PMI_SIZE)"));
  EXPECT_EQ(run(command(1, {"Euler", "--frames", "2"}, EXERCISE3)).status, 0);
}

}  // namespace
}  // namespace spring_pendulum
