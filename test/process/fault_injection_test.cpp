// Every system call of a run for its files fails once: one line, exit status 1, and no file is lost.
#include <csignal>
#include <filesystem>
#include <map>
#include <set>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

using testing::AnyOf;

bool isUnfinished(const std::string& name) {
  return name.find(".tmp") != std::string::npos;
}

/// Removes with these what it leaves behind, so if one of them fails, something may stay.
bool cleansUp(const std::string& call) {
  return call == "unlinkat" || call == "fstatat" || call == "fstat";
}

class FaultInjection : public testing::TestWithParam<std::string> {
 protected:
  /// What a run finds: frames and an energy file of an earlier run, and a file of a killed one.
  static void fill(const TemporaryFolder& folder) {
    folder.write("particle.txt", kTwoParticles);
    folder.write("run.yaml", "frames: 3\n");
    folder.write("frame_0000.txt", "earlier");
    folder.write("frame_0001.txt", "earlier");
    folder.write("frame_0002.txt", std::string(200, 'e'));
    folder.write("frame_0007.txt", "earlier");
    folder.write(".frame_0004.txt.tmp", "killed");
    folder.write(".e.csv.tmp", std::string(10000, 'k'));
    folder.write("e.csv", "earlier energies");
  }

  static Command command(const TemporaryFolder& folder) {
    return exercise3(folder, {"Runge-Kutta-4", "--config", "run.yaml", "--energy", "e.csv"});
  }

  FaultInjection() {
    TemporaryFolder folder;
    fill(folder);
    earlier_ = filesIn(folder.path());
    EXPECT_EQ(run(command(folder)).status, 0);
    finished_ = filesIn(folder.path());
    EXPECT_EQ(finished_.size(), 6U);
  }

  void expectNothingLost(const Files& files, const std::string& call) const {
    EXPECT_EQ(files.at("particle.txt"), earlier_.at("particle.txt"));
    EXPECT_EQ(files.at("run.yaml"), earlier_.at("run.yaml"));
    EXPECT_THAT(files.at("e.csv"), AnyOf(earlier_.at("e.csv"), finished_.at("e.csv")));
    std::set<std::string> earlier_frames, new_frames;
    for (const auto& [name, text] : files) {
      if (name.substr(0, 6) != "frame_") continue;
      const bool is_new = finished_.count(name) == 1 && finished_.at(name) == text;
      (is_new ? new_frames : earlier_frames).insert(name);
      EXPECT_TRUE(is_new || text == earlier_.at(name)) << name;
    }
    EXPECT_TRUE(earlier_frames.empty() || new_frames.empty());
    if (GetParam() != "fail" || cleansUp(call)) return;
    for (const auto& [name, text] : files)
      EXPECT_TRUE(!isUnfinished(name) || earlier_.count(name) == 1) << name;
  }

  void expectTold(const Result& result, const Files& files) const {
    if (result.status == 0) {
      EXPECT_EQ(result.errors, "");
      for (const auto& [name, text] : finished_) EXPECT_EQ(files.at(name), text) << name;
      return;
    }
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1);
    EXPECT_THAT(result.errors, testing::MatchesRegex("/.*: .*\n")) << result.errors;
    EXPECT_EQ(result.output, "");
  }

  Files earlier_;
  Files finished_;
};

TEST_P(FaultInjection, AtEveryCall) {
  std::map<std::string, int> failures;  // by call
  int count = 0;
  for (;; ++count) {
    const TemporaryFolder folder;
    fill(folder);
    Result result;
    const std::string call = disturb(command(folder), count + 1, GetParam(), result);
    if (call.empty()) break;
    SCOPED_TRACE(call + ", call " + std::to_string(count + 1) + ": " + result.errors);
    const Files files = filesIn(folder.path());
    expectNothingLost(files, call);
    if (GetParam() == "kill") {
      EXPECT_EQ(result.status, 128 + SIGKILL);
      ASSERT_EQ(run(command(folder)).status, 0);
      EXPECT_EQ(filesIn(folder.path()), finished_);
    } else if (GetParam() == "short" || GetParam() == "again") {
      EXPECT_EQ(result.status, 0);
      EXPECT_EQ(files, finished_);
    } else {
      expectTold(result, files);
      failures[call] += result.status;
    }
    if (HasFailure()) break;
  }
  EXPECT_GT(count, GetParam() == "short" || GetParam() == "again" ? 5 : 50);
  if (GetParam() != "fail") return;
  for (const char* call : {"open", "openat", "write", "read", "renameat"})
    EXPECT_GT(failures[call], 0) << call;
}

INSTANTIATE_TEST_SUITE_P(Kinds, FaultInjection,
                         testing::Values("fail", "broken", "kill", "short", "again"),
                         [](const auto& kind) { return kind.param; });

TEST(FaultsOfAResumedRun, KeepTheEnergiesOfTheFirstPart) {
  std::string name = "first";
  for (int call = 1; !name.empty(); ++call) {
    const TemporaryFolder folder;
    folder.write("s.txt", "# state of 2 particles at frame 1, t = 0.1 s\n0 0 1 0 0\n1 0 1 0 0\n");
    folder.write("e.csv", "frame\n0,first part\n");
    const Command command =
        exercise3(folder, wordsOf("Euler s.txt --resume --frames 3 --no-frames --energy e.csv"));
    Result result;
    name = disturb(command, call, "fail", result);
    EXPECT_THAT(readFile(folder.path("e.csv")), testing::HasSubstr("\n0,first part\n")) << name;
  }
}

/// Makes the files of a program that cannot create a thread; 0: it can create all.
Files filesWithout(int thread, const std::string& kind, std::vector<std::string> program) {
  const TemporaryFolder folder;
  folder.write("particle.txt", chainOf(20000));
  folder.write("study.yaml", "base: {frames: 2}\naxes: {stiffness: {linear: [20, 80, 6]}}\n");
  const Result result = run({std::move(program),
                             folder.path(),
                             {{"LD_PRELOAD", FAULT_INJECTION},
                              {"FAULT_THREAD", std::to_string(thread)},
                              {"FAULT_KIND", kind}}});
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  return filesIn(folder.path());
}

TEST(ThreadFaults, ChangeNoFile) {
  const std::vector<std::string> programs[] = {
      {EXERCISE3, "Runge-Kutta-4", "--frames", "3", "--threads", "3"},
      {SWEEP, "study.yaml", "--threads", "3"},
#ifdef RECORD_BAG
      {RECORD_BAG, "Runge-Kutta-4", "--frames", "3", "--threads", "3", "--bag", "x.bag"},
#endif
  };
  for (const auto& program : programs) {
    const Files expected = filesWithout(0, "", program);
    for (const char* const kind : {"fail", "broken"})
      for (int thread = 1; thread <= 4; ++thread) {
        SCOPED_TRACE(program.front() + " " + kind + " " + std::to_string(thread));
        EXPECT_TRUE(filesWithout(thread, kind, program) == expected);
      }
  }
}

}  // namespace
}  // namespace spring_pendulum
