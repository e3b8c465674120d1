// sweep run as a program: the same table however it is run, and whatever is done to it.
#include "base/numbers.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <map>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

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
      command.arguments.insert(command.arguments.begin(), {MPIEXEC, "-n", std::to_string(ranks)});
      command.environment = {{"OMPI_ALLOW_RUN_AS_ROOT", "1"},
                             {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"},
                             {"OMPI_MCA_rmaps_base_oversubscribe", "1"},
                             {"PRTE_MCA_rmaps_default_mapping_policy", ":oversubscribe"},
                             {"OMPI_MCA_mpi_yield_when_idle", "1"}};
    }
#endif
    return command;
  }

  /// The table of an undisturbed run on one thread.
  std::string table() const {
    EXPECT_EQ(run(sweep({"--threads", "1", "-o", "whole.csv"})).errors, "");
    return readFile(folder_.path("whole.csv"));
  }

  /// The fields of a row; empty: there is no such case.
  static std::vector<std::string> row(const std::string& table, int index) {
    std::istringstream lines(table);
    std::string line;
    for (int i = -1; i <= index; ++i) std::getline(lines, line);
    std::vector<std::string> fields;
    for (std::istringstream text(line); std::getline(text, line, ',');) fields.push_back(line);
    return fields;
  }

  void expectRunOfExercise3(int index, const std::vector<std::string>& fields) const {
    const Result printed = run(sweep({"--case", std::to_string(index), "-o", "alone"}));
    EXPECT_EQ(printed.errors, "");
    const std::string options(printed.output, 10, printed.output.size() - 11);  // of Exercise3
    const Result alone = run(exercise3(folder_, wordsOf(options)));
    const std::string verdict = fmt::format("verdict: {}\n", fields.end()[-6]);
    const double error = std::stod(fields.end()[-5]), bound = std::stod(fields.end()[-4]);
    const std::string where = readFile(folder_.path("study.yaml")) + printed.output;
    EXPECT_THAT(alone.output, testing::EndsWith(verdict)) << where;
    EXPECT_THAT(alone.output, HasSubstr(fields.end()[-3] + " force evaluations")) << where;
    const double energy = std::stod(fields.end()[-7]);
    const auto balance = std::isnan(energy) ? "" : "energy error " + roundedText(energy, 2);
    EXPECT_THAT(alone.output, HasSubstr(balance)) << where;
    if (alone.output.find("position error below") != std::string::npos) {
      EXPECT_THAT(alone.output, HasSubstr("error below " + roundedText(1.05 * bound, 2))) << where;
    } else if (std::isfinite(error)) {
      EXPECT_THAT(alone.output, HasSubstr("position error " + roundedText(error, 2))) << where;
    }
    if (alone.status != 0) return;
    const std::vector<std::string> frames = listFolder(folder_.path("alone"));
    ASSERT_FALSE(frames.empty()) << where;
    EXPECT_THAT(readFile(folder_.path("alone/" + frames.back())),
                testing::EndsWith(fields.end()[-2] + " " + fields.end()[-1] + "\n"))
        << where;
  }

  TemporaryFolder folder_;
};

TEST_F(Sweep, TableDoesNotDependOnThreadsAndRanks) {
  const std::string expected = table();
  EXPECT_THAT(expected, HasSubstr(",diverged,"));
  EXPECT_EQ(run(sweep({"--threads", "3", "-o", "threads.csv"})).status, 0);
  EXPECT_EQ(readFile(folder_.path("threads.csv")), expected);
#ifdef MPIEXEC
  for (const int ranks : {2, 4}) {
    EXPECT_EQ(run(sweep({"-o", "ranks.csv"}, ranks)).errors, "");
    EXPECT_EQ(readFile(folder_.path("ranks.csv")), expected) << ranks;
    std::filesystem::remove(folder_.path("ranks.csv"));
  }
  folder_.write("other.yaml", std::string(kStudy) + "# another one\n");
  for (const std::string other :
       {"study.yaml -o o.csv", "study.yaml -o t.csv --shard 2/3", "other.yaml -o t.csv"}) {
    const Result result = run(sweep(wordsOf("-o t.csv : -n 1 " SWEEP " " + other), 2));
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.errors, HasSubstr("all ranks need the same study, --output and --shard\n"));
  }
#endif
}

TEST_F(Sweep, ShardsThatFinishTogetherWriteOneTable) {
  folder_.write("study.yaml",
                "base: {particles: chain.txt, frames: 2}\naxes: {gravity: {linear: [2, 9, 800]}}");
  const std::string expected = table();
  for (int round = 0; round < 8; ++round) {
    const std::string name = std::to_string(round) + ".csv";
    std::vector<std::unique_ptr<Process>> shards;
    for (const char* part : {"1/4", "2/4", "3/4", "4/4"}) {
      Command shard = sweep({"--threads", "1", "-o", name, "--shard", part});
      if (round >= 4)  // without locks: two may want to write the table at once
        shard.environment = {{"LD_PRELOAD", FAULT_INJECTION}, {"FAULT_KIND", "unlocked"}};
      shards.push_back(std::make_unique<Process>(shard));
    }
    for (const auto& shard : shards)
      EXPECT_EQ(shard->wait().errors.substr(0, round < 4 ? 999 : 0), "");
    EXPECT_EQ(readFile(folder_.path(name)), expected);
  }
}

TEST_F(Sweep, KillsAndSignalsDoNotChangeTheTable) {
  const std::string expected = table();
  std::mt19937 generator(1);
  for (int kill = 0; kill < 8; ++kill) {
    std::vector<std::string> options{"-o", "killed.csv", "--threads", std::to_string(1 + kill % 2)};
    if (kill % 3 == 1) options.insert(options.end(), {"--shard", "2/3"});
    Process process(sweep(options, kill % 4 == 2 ? 2 : 1));
    if (kill == 0) {
      process.waitForFile(folder_.path("killed.csv.journal"));
      process.sendSignal(SIGTERM);
      const Result stopped = process.wait();
      EXPECT_EQ(stopped.status, 128 + SIGTERM);
      EXPECT_THAT(stopped.errors, HasSubstr(" of 400 cases are done; the same command goes on\n"));
      continue;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50 + generator() % 150));
    process.sendSignal(SIGKILL);
    process.wait();
  }
  EXPECT_EQ(run(sweep({"-o", "killed.csv"})).errors, "");
  EXPECT_EQ(readFile(folder_.path("killed.csv")), expected);
}

std::string randomChain(std::mt19937& generator) {
  const auto uniform = [&](double least, double most) {
    return least + (most - least) * static_cast<double>(generator()) / 4294967296.0;
  };
  std::string text;
  double x = 0.0, y = 0.0, angle = uniform(0.0, 3.0);
  for (auto left = 3 + generator() % 12; left > 0; --left) {
    text += fmt::format("{} {} {}\n", x, y, uniform(0.5, 2.0));
    angle += uniform(-0.4, 0.4);
    x += uniform(0.9, 1.1) * std::cos(angle);
    y += uniform(0.9, 1.1) * std::sin(angle);
  }
  return text;
}

/// A study as somebody could write it. Without damping, many are sensitive after 20 s.
std::string randomStudy(std::mt19937& generator) {
  const auto pick = [&](const std::vector<std::string>& texts) {
    return texts[generator() % texts.size()];
  };
  return fmt::format(
      "base: {{particles: chain.txt, damping: {}, {}, {}}}\naxes: {{method: [{}], {}}}\n{}"
      "columns: [energy_error, verdict, position_error, error_bound, force_evaluations, tip_x, "
      "tip_y]\n",
      pick({"0", "0", "0.5"}),
      pick({"duration: 2.3", "frames: 500", "frames: 500, on_divergence: continue"}),
      pick({"reference: always", "reference: always", "reference: never", "gravity: 20",
            "air_drag: 0.1", "sleep: 1e-3", "gravity: -1"}),
      pick({"Euler, Auto", "Runge-Kutta-4, Taylor-8", "Auto, Radau-9",
            "Velocity-Verlet, Dormand-Prince-5", "Backward-Euler, Taylor-12",
            "Runge-Kutta-2, Stabilized-Taylor-4"}),
      pick({"stiffness: {linear: [10, 90, 2]}", "mass_factor: [0.5, 3]", "rest_length: [0.7, 1]"}),
      pick({"", "random: {seed: 4, samples: 2, displacement: {normal: [0, 0.01]}}\n",
            "random: {samples: 2, mass_factor: {log_normal: [1, 0.3]},\n"
            "         velocity: {uniform: [-1, 1]}}\n"}));
}

TEST_F(Sweep, RowsAreRunsOfExercise3) {
  std::mt19937 generator(1);
  std::map<std::string, int> verdicts;
  for (int study = 0; study < 12; ++study) {
    folder_.write("chain.txt", randomChain(generator));
    folder_.write("study.yaml", randomStudy(generator));
    const std::string rows = table();
    const int cases = static_cast<int>(std::count(rows.begin(), rows.end(), '\n')) - 1;
    for (int i = 0; i < cases; i += 1 + static_cast<int>(generator() % 2)) {
      expectRunOfExercise3(i, row(rows, i));
      ++verdicts[*(row(rows, i).end() - 6)];
    }
  }
  EXPECT_GT(verdicts["ok"], 20);
  EXPECT_GT(std::min(verdicts["sensitive"], verdicts["diverged"]), 1);
}

TEST_F(Sweep, DrawsItsTableWithTheTitleAsText) {
  std::string study(kStudy);
  study.replace(study.find("log: xy"), 7, R"(log: xy, title: "a\nsystem('touch x')\n#")");
  folder_.write("study.yaml", study);
  EXPECT_EQ(run(sweep({"-o", "drawn.csv", "--plot"})).errors, "");
  EXPECT_EQ(readFile(folder_.path("drawn.png")).substr(0, 4), "\x89PNG");
  EXPECT_FALSE(std::filesystem::exists(folder_.path("x")));
}

TEST_F(Sweep, KeepsItsJournalUntilThePictureIsDrawn) {
  folder_.write("chain.txt", chainOf(3));
  folder_.write("study.yaml",
                "base: {particles: chain.txt, frames: 2}\n"
                "axes: {stiffness: {linear: [1, 50, 102]}}\ncolumns: [tip_x, tip_y]\n"
                "plot: {type: lines, x: stiffness, y: tip_x, panels: tip_y}\n");
  for (const int status : {0, 2, 2}) {  // the last one goes on at once
    const Result end = run(sweep({"-o", "t.csv", "--plot", "--shard", status ? "2/2" : "1/2"}));
    EXPECT_EQ(end.status, status) << end.errors;
    EXPECT_EQ(end.errors.rfind("plot: panels: tip_y has 102", 0) == 0, status == 2);
  }
  EXPECT_TRUE(std::filesystem::exists(folder_.path("t.csv.journal")));
}

/// The journal of two of three cases.
class SweepWithAJournal : public Sweep {
 protected:
  SweepWithAJournal() {
    folder_.write("study.yaml",
                  "base: {particles: chain.txt, frames: 2}\naxes: {stiffness: [20, 30, 40]}\n"
                  "columns: [tip_x, verdict, error_bound]\n");
    Command shard = sweep({"--shard", "1/2", "-o", "t.csv"});
    shard.environment = {{"SLURM_STEP_NUM_TASKS", "2"}};  // MPI does not know of them
    EXPECT_EQ(run(shard).status, 0);
    journal_ = readFile(folder_.path("t.csv.journal"));
  }

  std::string journal_;
};

TEST_F(SweepWithAJournal, DropsEveryTornEnd) {
  const std::string expected = table();
  for (std::size_t size = 0; size < journal_.size(); size += size % 7 + 1) {
    folder_.write("t.csv.journal", journal_.substr(0, size));
    EXPECT_EQ(run(sweep({"-o", "t.csv"})).status, 0);
    EXPECT_EQ(readFile(folder_.path("t.csv")), expected) << size;
  }
}

TEST_F(SweepWithAJournal, RefusesDamage) {
  const std::size_t head = journal_.find('\n') + 1;
  std::vector<std::string> damaged{"notes without a line end", journal_.substr(0, head) + "\n"};
  for (std::size_t i = head; i + 1 < journal_.size(); i += 5) {
    damaged.push_back(journal_);
    damaged.back()[i] ^= 1;
    damaged.push_back(journal_);
    damaged.back().erase(i, 1);
  }
  for (const std::string& text : damaged) {
    folder_.write("t.csv.journal", text);
    const Result result = run(sweep({"-o", "t.csv"}));
    EXPECT_EQ(result.status, 2) << text;
    EXPECT_THAT(result.errors, testing::ContainsRegex("is damaged; remove the line|another study"));
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_EQ(readFile(folder_.path("t.csv.journal")), text);
  }
}

TEST_F(SweepWithAJournal, TellsEveryFaultInOneLine) {
  const std::string expected = table();
  Files errors;  // by call, "": no call failed
  for (int call = 1; errors.count("") == 0; ++call) {
    folder_.write("t.csv.journal", journal_);
    Result result;
    const std::string name = disturb(sweep({"-o", "t.csv"}), call, "fail", result);
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), result.status);
    errors[name] += result.errors;
    EXPECT_EQ(run(sweep({"-o", "t.csv"})).status, 0);
    EXPECT_EQ(readFile(folder_.path("t.csv")), expected);
  }
  EXPECT_THAT(errors["write"], HasSubstr("journal: could not be written: Input/output error\n"));
  EXPECT_THAT(errors["remove"], HasSubstr("journal: could not be removed: Input/output error; "));
}

TEST_F(Sweep, RunsASingleFrameAndAFixedParticleWithoutMass) {
  folder_.write("chain.txt", "0 0 0\n1 0 1\n2 0 1\n");
  folder_.write("study.yaml",
                "base: {particles: chain.txt, frames: 1}\n"
                "axes: {mass_factor: [1, 2]}\ncolumns: [linear_step, verdict]\n");
  EXPECT_EQ(row(table(), 1), (std::vector<std::string>{"1", "2", "nan", "ok"}));
}

TEST_F(Sweep, FindsOutBeforeTheFirstCaseWhatItCannotDraw) {
  const char* const map = "map, y: damping, color: verdict";
  const std::tuple<const char*, std::string, const char*> bad[] = {
      {"method: [Euler, Auto]", map,
       "several rows have stiffness = 1 and damping = 0; draw them in panels or leave some out"},
      {"gravity: [9.81]", map,
       "damping = 0 cannot be on a logarithmic axis; leave out log or this value"},
      {"gravity: [9.81]", "histogram, lines: damping", "lines: a histogram does not use it"},
      {"gravity: [9.81]", "lines, y: verdict", "only numbers can be drawn, got 'ok'"}};
  for (const auto& [axis, plot, message] : bad) {
    folder_.write("study.yaml", fmt::format("base: {{particles: chain.txt, frames: 2}}\n"
                                            "axes: {{{}, stiffness: [1, 2], damping: [0, 1]}}\n"
                                            "plot: {{type: {}, x: stiffness, log: y}}\n",
                                            axis, plot));
    const Result result = run(sweep({"-o", "t.csv", "--plot"}));
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.errors, fmt::format("plot: {}\n", message));
    EXPECT_EQ(listFolder(folder_.path()), (std::vector<std::string>{"chain.txt", "study.yaml"}));
  }
  std::filesystem::create_directory(folder_.path("t.png"));
  EXPECT_THAT(run(sweep({"-o", "t.csv", "--plot", "--shard", "1/2"})).errors, HasSubstr("t.png"));
}

TEST_F(Sweep, TwoStudiesAreNotOneTable) {
  folder_.write("other.yaml", std::string(kStudy) + "# another one\n");
  Command other = sweep({"-o", "t.csv"});
  other.arguments[1] = "other.yaml";
  for (int round = 0; round < 5; ++round) {
    Process first(sweep({"-o", "t.csv", "--threads", "1"}));
    Process second(other);
    const Result results[] = {first.wait(), second.wait()};
    EXPECT_NE(results[0].status == 0, results[1].status == 0) << round;
    EXPECT_THAT(results[0].errors + results[1].errors,
                testing::AnyOf(HasSubstr("is the journal of another study"),
                               HasSubstr("another run is writing")));
    std::filesystem::remove(folder_.path("t.csv"));
  }
}

TEST_F(Sweep, AnEarlierTableIsNotItsOwn) {
  const Command shard = sweep({"-o", "t.csv", "--shard", "2/2"});
  folder_.write("study.yaml",
                "base: {particles: chain.txt, duration: 4}\naxes: {time_step: [1e-9, 0.1]}\n");
  folder_.write("t.csv", "case,x\n0,1\n");
  EXPECT_THAT(run(shard).errors, HasSubstr("t.csv: exists; remove it to run its shards anew"));
  EXPECT_EQ(run(sweep({"-o", "t.csv", "--shard", "3/3"}, 2)).output, "shard 3 has no case\n");
  Process process(sweep({"-o", "t.csv", "--threads", "1"}));
  process.waitForFile(folder_.path("t.csv.journal"));
  EXPECT_EQ(run(shard).errors, "");
  EXPECT_THAT(readFile(folder_.path("t.csv.journal")), HasSubstr("\n1,"));
  std::filesystem::remove(folder_.path("t.csv.journal"));
  process.sendSignal(SIGTERM);
  EXPECT_THAT(process.wait().errors, testing::ContainsRegex("journal: (was removed|could not)"));
}

TEST_F(Sweep, RefusesBadArguments) {
  const std::pair<std::vector<std::string>, const char*> bad[] = {
      {{"other.yaml"}, "'other.yaml': give only one STUDY"},
      {{"--shard", "4/3"}, "--shard: must be I/N with I from 1 to N, N at most 1e9, got '4/3'"},
      {{"--shard", "2/9223372036854775807"}, "N at most 1e9"},
      {{"--threads", "1", "--threads", "2"}, "--threads: is given twice"},
      {{"--case", "0", "-o", "x", "--plot"}, "--case: runs a single case; leave out --plot"},
      {{"--case", "400"}, "--case: must be from 0 to 399, got 400"},
      {{"--case", "3"}, "--case: its particles are in no file; give a folder with --output"},
      {{"-o", "chain.txt"}, "is an input of this run"},
      {{"-o", "study.png", "--plot"}, "choose another file"},
      {{"-o", "."}, "is the folder of another output"},
  };
  const Command alone{{SWEEP, "study.yaml"}, folder_.path(), {{"SLURM_STEP_NUM_TASKS", "4"}}, {}};
  EXPECT_THAT(run(alone).errors, HasSubstr("several processes, each alone: use --shard"));
  for (const auto& [arguments, message] : bad) {
    const Result result = run(sweep(arguments));
    EXPECT_EQ(result.status, 2) << message;
    EXPECT_THAT(result.errors, HasSubstr(message));
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  }
  EXPECT_EQ(listFolder(folder_.path()), (std::vector<std::string>{"chain.txt", "study.yaml"}));
}

}  // namespace
}  // namespace spring_pendulum
