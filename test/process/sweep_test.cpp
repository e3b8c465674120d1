// sweep run as a program: the same table however it is run, and whatever is done to it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

using testing::HasSubstr;

/// 400 cases of 20 scenes; some diverge. Takes a second on one core.
constexpr const char* kStudy = R"(base:
  particles: chain.txt
  duration: 4
axes:
  method: [Euler, Runge-Kutta-2, Runge-Kutta-4, Auto]
  time_step: {log: [0.0001, 0.2, 5]}
random:
  seed: 5
  samples: 20
  mass_factor: {log_normal: [0.3, 0.5]}
  displacement: {normal: [0, 0.01]}
columns: [verdict, position_error, error_bound, measured_until, energy_error, largest_stretch, tip_x,
          tip_y, diverged_at, seconds, force_evaluations, linear_step]
plot: {type: lines, x: time_step, y: position_error, lines: method, log: xy}
)";

class Sweep : public testing::Test {
 protected:
  Sweep() {
    folder_.write("chain.txt", chainOf(5));
    folder_.write("study.yaml", kStudy);
  }

  Command sweep(const std::vector<std::string>& options, int ranks = 1) const {
    Command command{{SWEEP, "study.yaml"}, folder_.path(), {}, {}};
    command.arguments.insert(command.arguments.end(), options.begin(), options.end());
#ifdef MPIEXEC
    if (ranks > 1) {
      const std::vector<std::string> launcher{MPIEXEC, "-n", std::to_string(ranks)};
      command.arguments.insert(command.arguments.begin(), launcher.begin(), launcher.end());
      command.environment = {{"OMPI_ALLOW_RUN_AS_ROOT", "1"},
                             {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"},
                             {"OMPI_MCA_rmaps_base_oversubscribe", "1"},
                             {"OMPI_MCA_mpi_yield_when_idle", "1"}};
    }
#endif
    return command;
  }

  /// The table of an undisturbed run on one thread.
  std::string table() const {
    const Result result = run(sweep({"--threads", "1", "-o", "whole.csv"}));
    EXPECT_EQ(result.status, 0) << result.errors;
    return readFile(folder_.path("whole.csv"));
  }

  /// The fields of a row; empty: there is no such case.
  static std::vector<std::string> row(const std::string& table, int index) {
    std::istringstream lines(table);
    std::string line;
    for (int i = -1; i <= index; ++i) std::getline(lines, line);
    std::vector<std::string> fields;
    std::istringstream text(line);
    while (std::getline(text, line, ',')) fields.push_back(line);
    return fields;
  }

  TemporaryFolder folder_;
};

TEST_F(Sweep, TableDoesNotDependOnThreadsRanksAndShards) {
  const std::string expected = table();
  EXPECT_EQ(std::count(expected.begin(), expected.end(), '\n'), 401);
  EXPECT_THAT(expected, HasSubstr(",diverged,"));
  EXPECT_THAT(expected, HasSubstr(",ok,"));
  EXPECT_EQ(run(sweep({"--threads", "3", "-o", "threads.csv"})).status, 0);
  EXPECT_EQ(readFile(folder_.path("threads.csv")), expected);
  for (const char* const shard : {"2/3", "3/3", "1/3"}) {
    EXPECT_FALSE(std::filesystem::exists(folder_.path("shards.csv")));
    EXPECT_EQ(run(sweep({"--shard", shard, "-o", "shards.csv"})).status, 0);
  }
  EXPECT_EQ(readFile(folder_.path("shards.csv")), expected);
  EXPECT_FALSE(std::filesystem::exists(folder_.path("shards.csv.journal")));
#ifdef MPIEXEC
  for (const int ranks : {2, 4}) {
    const Result result = run(sweep({"-o", "ranks.csv"}, ranks));
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(readFile(folder_.path("ranks.csv")), expected) << ranks;
    std::filesystem::remove(folder_.path("ranks.csv"));
  }
#endif
}

TEST_F(Sweep, ShardsThatFinishTogetherWriteOneTable) {
  folder_.write("study.yaml",
                "base: {particles: chain.txt, frames: 2}\n"
                "axes: {stiffness: {linear: [20, 80, 8]}}\n");
  const std::string expected = table();
  for (int round = 0; round < 4; ++round) {
    std::vector<std::unique_ptr<Process>> shards;
    for (int i = 1; i <= 4; ++i) {
      shards.push_back(std::make_unique<Process>(
          sweep({"--threads", "1", "-o", "t.csv", "--shard", std::to_string(i) + "/4"})));
    }
    for (const auto& shard : shards) {
      const Result result = shard->wait();
      EXPECT_EQ(result.status, 0);
      EXPECT_EQ(result.errors, "");
    }
    EXPECT_EQ(readFile(folder_.path("t.csv")), expected);
    std::filesystem::remove(folder_.path("t.csv"));
  }
}

TEST_F(Sweep, KillsDoNotChangeTheTable) {
  const std::string expected = table();
  std::mt19937 generator(1);
  for (int kill = 0; kill < 8; ++kill) {
    std::vector<std::string> options{"-o", "killed.csv", "--threads", std::to_string(1 + kill % 2)};
    if (kill % 3 == 1) options.insert(options.end(), {"--shard", "2/3"});
    const int ranks = kill % 4 == 2 ? 2 : 1;
    Process process(sweep(options, ranks));
    std::this_thread::sleep_for(std::chrono::milliseconds(50 + generator() % 150));
    process.sendSignal(SIGKILL);
    process.wait();
  }
  const Result result = run(sweep({"-o", "killed.csv"}));
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(readFile(folder_.path("killed.csv")), expected);
}

TEST_F(Sweep, GoesOnAfterASignal) {
  Process process(sweep({"-o", "stopped.csv", "--threads", "1"}));
  process.waitForFile(folder_.path("stopped.csv.journal/1.journal"));
  process.sendSignal(SIGTERM);
  const Result stopped = process.wait();
  EXPECT_EQ(stopped.status, 128 + SIGTERM);
  EXPECT_THAT(stopped.errors, HasSubstr(" of 400 cases are done; the same command goes on\n"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path("stopped.csv")));
  EXPECT_EQ(run(sweep({"-o", "stopped.csv"})).status, 0);
  EXPECT_EQ(readFile(folder_.path("stopped.csv")), table());
}

TEST_F(Sweep, RefusesTheJournalOfAnotherStudy) {
  Process process(sweep({"-o", "t.csv", "--threads", "1"}));
  process.waitForFile(folder_.path("t.csv.journal/1.journal"));
  process.sendSignal(SIGTERM);
  process.wait();
  folder_.write("chain.txt", chainOf(6));
  const Result result = run(sweep({"-o", "t.csv"}));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("is the journal of another study or version; remove "));
}

TEST_F(Sweep, ACaseIsARunOfExercise3) {
  const std::vector<std::string> expected = row(table(), 311);
  const Result alone = run(sweep({"--case", "311", "-o", "alone"}));
  EXPECT_EQ(alone.status, 0) << alone.errors;
  EXPECT_THAT(alone.output, HasSubstr("verdict: " + expected[4] + "\n"));
  std::string last;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path("alone"))) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("frame_", 0) == 0) last = std::max(last, name);
  }
  const std::string frame = readFile(folder_.path("alone/" + last));
  EXPECT_THAT(frame, testing::EndsWith(expected[10] + " " + expected[11] + "\n"));

  std::istringstream words(alone.output.substr(0, alone.output.find('\n')));
  std::vector<std::string> arguments;
  for (std::string word; words >> word;) arguments.push_back(word);
  ASSERT_EQ(arguments.front(), "Exercise3");
  arguments.erase(arguments.begin());
  arguments.insert(arguments.end(), {"-o", "again"});
  const Result again = run(exercise3(folder_, arguments));
  EXPECT_EQ(again.status, 0) << again.errors;
  EXPECT_EQ(readFile(folder_.path("again/" + last)), frame);
}

TEST_F(Sweep, ACaseLeavesTheFilesOfItsStudyAsTheyAre) {
  std::filesystem::create_directory(folder_.path("own"));
  folder_.write("own/particle.txt", chainOf(5));
  std::string study(kStudy);
  study.replace(study.find("chain.txt"), 9, "own/particle.txt");
  folder_.write("study.yaml", study);
  EXPECT_EQ(run(sweep({"--case", "311", "-o", "own"})).status, 0);
  EXPECT_EQ(readFile(folder_.path("own/particle.txt")), chainOf(5));
  folder_.write("own/case_311.txt", chainOf(5));
  study.replace(study.find("own/particle.txt"), 16, "own/case_311.txt");
  folder_.write("study.yaml", study);
  EXPECT_EQ(run(sweep({"--case", "311", "-o", "own"})).status, 2);
  EXPECT_EQ(readFile(folder_.path("own/case_311.txt")), chainOf(5));
}

TEST_F(Sweep, RowsOfASensitiveMotionAreThoseOfExercise3) {
  folder_.write("chain.txt", chainOf(11));
  folder_.write("study.yaml",
                "base: {particles: chain.txt, damping: 0, frames: 500}\n"
                "axes: {method: [Runge-Kutta-4, Taylor-8]}\ncolumns: [verdict]\n");
  const char* const methods[] = {"Runge-Kutta-4", "Taylor-8"};
  for (int i = 0; i < 2; ++i) {
    const Result alone = run(exercise3(
        folder_, {methods[i], "chain.txt", "--damping", "0", "--frames", "500", "--no-frames"}));
    EXPECT_THAT(alone.output, HasSubstr("verdict: " + row(table(), i).back() + "\n"));
  }
}

TEST_F(Sweep, StartsAtRestAsExercise3Does) {
  folder_.write("study.yaml",
                "base:\n  particles: chain.txt\n  duration: 1\n  method: Auto\n"
                "axes:\n  start: [file, at_rest]\n  tolerance: [1e-6, 1e-4]\ncolumns: [verdict]\n");
  EXPECT_THAT(table(), testing::Not(HasSubstr("inaccurate")));
  EXPECT_EQ(row(table(), 3).back(), "ok");
}

TEST_F(Sweep, DrawsItsTable) {
  const Result result = run(sweep({"-o", "drawn.csv", "--plot"}));
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.errors, "");
  EXPECT_EQ(readFile(folder_.path("drawn.png")).substr(0, 4), "\x89PNG");
}

// Every method and every step ends at the duration, and what can't is refused.
TEST_F(Sweep, EndsAtTheDuration) {
  folder_.write("study.yaml",
                "base: {particles: chain.txt, duration: 1, reference: always}\n"
                "axes: {method: [Runge-Kutta-4, Auto], time_step: {log: [0.0003, 0.1, 9]}}\n"
                "columns: [measured_until]\n");
  const std::string ends = table();
  for (int i = 0; i < 18; ++i) EXPECT_NEAR(std::stod(row(ends, i).back()), 1.0, 1e-12) << ends;
  const char* const refused[] = {"duration: 1}\naxes: {time_step: [0.1, 0.3]}",
                                 "time_step: 0.3}\naxes: {duration: [0.9, 1]}"};
  for (const char* const study : refused) {
    folder_.write("study.yaml", std::string("base: {particles: chain.txt, ") + study);
    const Result result = run(sweep({}));
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.errors,
                HasSubstr("case 1: time_step: whole steps must end at the duration"));
  }
}

TEST_F(Sweep, RunsASingleFrameAndAFixedParticleWithoutMass) {
  folder_.write("chain.txt", "0 0 0\n1 0 1\n2 0 1\n");
  folder_.write("study.yaml",
                "base: {particles: chain.txt, frames: 1}\n"
                "axes: {mass_factor: [1, 2]}\ncolumns: [linear_step, verdict]\n");
  EXPECT_EQ(row(table(), 1), (std::vector<std::string>{"1", "2", "nan", "ok"}));
}

TEST_F(Sweep, FindsOutBeforeTheFirstCaseWhatItCannotDraw) {
  std::filesystem::create_directory(folder_.path("t.png"));
  const Result folder = run(sweep({"-o", "t.csv", "--plot"}));
  EXPECT_EQ(folder.status, 1);
  EXPECT_THAT(folder.errors, HasSubstr("t.png"));
  folder_.write("study.yaml",
                "base: {particles: chain.txt, frames: 2}\n"
                "axes: {method: [Euler, Auto], stiffness: [1, 2], damping: [0, 1]}\n"
                "plot: {type: map, x: stiffness, y: damping, color: verdict}\n");
  const Result map = run(sweep({"-o", "t.csv", "--plot"}));
  EXPECT_EQ(map.status, 2);
  EXPECT_THAT(map.errors, HasSubstr("method varies, too; use it for panels"));
  EXPECT_EQ(listFolder(folder_.path()),
            (std::vector<std::string>{"chain.txt", "study.yaml", "t.png"}));
}

// 64 threads would need more address space.
TEST_F(Sweep, NeedsNoMoreThreadsThanTheSystemGrants) {
  folder_.write(
      "study.yaml",
      "base: {particles: chain.txt, frames: 2}\naxes: {stiffness: {linear: [20, 80, 99]}}\n");
  Command command = sweep({"-o", "few.csv", "--threads", "64"});
  command.arguments.insert(command.arguments.begin(), {"prlimit", "--as=300000000"});
  const Result result = run(command);
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(readFile(folder_.path("few.csv")), table());
}

TEST_F(Sweep, DrawsATitleAsText) {
  folder_.write("study.yaml",
                std::string(kStudy).replace(std::string(kStudy).find("log: xy"), 7,
                                            R"(log: xy, title: "a\nsystem('touch x')\n#")"));
  EXPECT_EQ(run(sweep({"-o", "drawn.csv", "--plot"})).status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_.path("x")));
}

TEST_F(Sweep, RefusesBadArguments) {
  const std::pair<std::vector<std::string>, const char*> bad[] = {
      {{"other.yaml"}, "'other.yaml': give only one STUDY"},
      {{"--shard", "4/3"}, "--shard: must be I/N with I from 1 to N, N at most 1e9, got '4/3'"},
      {{"--shard", "1"}, "--shard: must be I/N"},
      {{"--shard", "2/9223372036854775807"}, "N at most 1e9"},
      {{"--threads", "1", "--threads", "2"}, "--threads: is given twice"},
      {{"--case", "0", "-o", "x", "--plot"}, "--case: runs a single case; leave out --plot"},
      {{"--threads", "0"}, "--threads: must be a whole number from 1 to 1024, got '0'"},
      {{"--case", "400"}, "--case: must be from 0 to 399, got 400"},
      {{"--case", "3"}, "has particles that are in no file; give a folder for them with --output"},
      {{"--outptu", "x"}, "did you mean '--output'?"},
      {{"-o", "chain.txt"}, "is an input of this run"},
      {{"-o", "study.png", "--plot"}, "choose another file"},
  };
  for (const auto& [arguments, message] : bad) {
    const Result result = run(sweep(arguments));
    EXPECT_EQ(result.status, 2) << message;
    EXPECT_THAT(result.errors, HasSubstr(message));
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  }
  EXPECT_EQ(listFolder(folder_.path()), (std::vector<std::string>{"chain.txt", "study.yaml"}));
}

TEST_F(Sweep, FullDiskIsOneLine) {
  Command command = sweep({"-o", "t.csv"});
  command.arguments.insert(command.arguments.begin(), {"prlimit", "--fsize=3000"});
  const Result result = run(command);
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, HasSubstr("journal: could not be written: File too large\n"));
  EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  EXPECT_EQ(run(sweep({"-o", "t.csv"})).status, 0);
  EXPECT_EQ(readFile(folder_.path("t.csv")), table());
}

}  // namespace
}  // namespace spring_pendulum
