// Exercise3 leaves complete frames of this run in a folder, and all files of others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <sched.h>
#include <sstream>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::StartsWith;

std::string frame(int index) {
  std::string number = std::to_string(index);
  number.insert(0, number.size() < 4 ? 4 - number.size() : 0, '0');
  return "frame_" + number + ".txt";
}

int countFrames(const std::string& folder) {
  const std::vector<std::string> names = listFolder(folder);
  return static_cast<int>(std::count_if(names.begin(), names.end(), [](const std::string& name) {
    return name.substr(0, 6) == "frame_";
  }));
}

/// A chain for a run of a few tenths of a second, and a run that does not end by itself.
class LongRun : public testing::Test {
 protected:
  static constexpr int kFrames = 200;
  static constexpr int kEndless = 1000000;

  LongRun() { folder_.write("particle.txt", chainOf(2000)); }

  Command command(const std::string& output, int frames = kFrames) const {
    return exercise3(folder_, {"Euler", "--output", output, "--frames", std::to_string(frames),
                               "--time-step", "0.001"});
  }

  /// The existing frames are those of a run that was not stopped.
  void expectWholeFrames(const std::string& output, const std::string& complete) const {
    const int count = std::min(countFrames(folder_.path(output)), kFrames);
    for (int i = 0; i < count; ++i) {
      ASSERT_EQ(readFile(folder_.path(output + "/" + frame(i))),
                readFile(folder_.path(complete + "/" + frame(i))))
          << i;
    }
  }

  TemporaryFolder folder_;
};

TEST_F(LongRun, KilledAtAnyTimeLeavesOnlyWholeFrames) {
  ASSERT_EQ(run(command("complete")).status, 0);
  for (int attempt = 0; attempt < 20; ++attempt) {
    const std::string killed = "killed" + std::to_string(attempt);
    Process process(command(killed, kEndless));
    process.waitForFile(folder_.path(killed + "/" + frame(5 * attempt)));
    usleep(100U * static_cast<unsigned>(attempt));  // in another phase of writing each time
    process.sendSignal(SIGKILL);
    ASSERT_EQ(process.wait().status, 128 + SIGKILL);
    expectWholeFrames(killed, "complete");
  }
}

TEST_F(LongRun, InterruptedEndsWithAWholeFrameAndTheClosingLine) {
  ASSERT_EQ(run(command("complete")).status, 0);
  for (const int signal_number : {SIGINT, SIGTERM}) {
    const std::string stopped = "stopped" + std::to_string(signal_number);
    Process process(command(stopped, kEndless));
    process.waitForFile(folder_.path(stopped + "/" + frame(3)));
    process.sendSignal(signal_number);
    const Result result = process.wait();
    EXPECT_EQ(result.status, 128 + signal_number);
    EXPECT_LT(result.seconds_after_signal, 1.0);  // 0.02
    const int count = countFrames(folder_.path(stopped));
    EXPECT_LT(count, kEndless);
    EXPECT_EQ(listFolder(folder_.path(stopped)).size(), static_cast<std::size_t>(count));
    EXPECT_THAT(result.output,
                StartsWith("Euler: 2000 particles, " + std::to_string(count) + " frames, "));
    expectWholeFrames(stopped, "complete");
  }
}

TEST_F(LongRun, ASecondRunIntoTheSameFolderIsRefused) {
  Process first(command("shared"));
  first.waitForFile(folder_.path("shared/" + frame(0)));
  first.sendSignal(SIGSTOP);  // it still exists when the second one starts
  const Result second = run(command("shared", 1));
  EXPECT_EQ(second.status, 1);
  EXPECT_EQ(second.errors,
            folder_.path("shared") +
                ": another run is writing here; use a different path for each run\n");
  first.sendSignal(SIGCONT);
  EXPECT_EQ(first.wait().status, 0);
  EXPECT_EQ(countFrames(folder_.path("shared")), kFrames);
  EXPECT_EQ(run(command("shared", 1)).status, 0);
  EXPECT_EQ(countFrames(folder_.path("shared")), 1);
}

TEST(Exercise3Output, FiveHundredFramesByDefault) {
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  const Result result = run(exercise3(folder, {"Runge-Kutta-4"}));
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.errors, "");
  EXPECT_THAT(result.output,
              MatchesRegex("Runge-Kutta-4: 2 particles, 500 frames, 4990 steps, 19960 force "
                           "evaluations, [0-9.]+ m?s integrating, [0-9.]+ m?s writing to " +
                           folder.path() + ".*\n"));
  EXPECT_EQ(listFolder(folder.path()).size(), 501U);
  EXPECT_EQ(readFile(folder.path(frame(0))), "0 0\n1 0\n");
  EXPECT_TRUE(std::filesystem::exists(folder.path(frame(499))));
}

TEST(Exercise3Output, AnUnstableTimeStepIsAWarningAtTheStart) {
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  const Result result = run(exercise3(folder, {"Runge-Kutta-4", "--no-frames", "--time-step=9"}));
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(
      result.errors,
      MatchesRegex("warning: Runge-Kutta-4 may be unstable with a time step of 9 s; .*or use "
                   "Auto\ndiverged at t = .*; largest stable step .*\n"));
}

TEST(Exercise3Output, AFrameIsTenStepsFromTheNext) {
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  ASSERT_EQ(run(exercise3(folder, {"Euler", "--frames", "3"})).status, 0);
  ASSERT_EQ(run(exercise3(folder, {"Euler", "--frames", "21", "--steps-per-frame", "1", "--output",
                                   "every/step"}))
                .status,
            0);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(readFile(folder.path(frame(i))),
              readFile(folder.path("every/step/" + frame(10 * i))));
  }
}

TEST(Exercise3Output, StaleFramesGoAndNothingElse) {
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  const std::vector<std::string> kept{"frame_12.txt",    "frame_0001.txt.bak", "frame_000a.txt",
                                      "xframe_0001.txt", "frame_0001.csv",     "frame_.txt",
                                      "frame_-0001.txt", "Frame_0001.txt",     "notes.txt"};
  for (const std::string& name : kept) folder.write(name, "kept\n");
  for (const int stale : {0, 1, 5, 9999, 10000, 123456789}) folder.write(frame(stale), "stale\n");
  EXPECT_THAT(run(exercise3(folder, {"Euler", "--frames", "2"})).output,
              HasSubstr(" to " + folder.path() + " (6 earlier frames removed), "));
  for (const std::string& name : kept) EXPECT_EQ(readFile(folder.path(name)), "kept\n") << name;
  EXPECT_EQ(listFolder(folder.path()).size(), kept.size() + 3);
  EXPECT_EQ(readFile(folder.path(frame(0))), "0 0\n1 0\n");
  EXPECT_TRUE(std::filesystem::exists(folder.path(frame(1))));
}

TEST(Exercise3Output, WhatIsNoFileIsNeverRemoved) {
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  folder.write(frame(0), "earlier\n");
  std::filesystem::create_directory(folder.path(frame(3)));
  const Result result = run(exercise3(folder, {"Euler"}));
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors,
              StartsWith(folder.path(frame(3)) +
                         ": has the name of a frame file but is not a regular file"));
  EXPECT_EQ(readFile(folder.path(frame(0))), "earlier\n");
}

/// Reads the output of a terminal until its other end closes, or until it contains `wanted`.
std::string readTerminal(int terminal, const std::string& wanted) {
  std::string text;
  for (char letter = 0; read(terminal, &letter, 1) == 1;) {
    text += letter;
    if (!wanted.empty() && text.find(wanted) != std::string::npos) break;
  }
  return text;
}

TEST(Exercise3Output, ATerminalIsToldHowFarALongRunIs) {
  const TemporaryFolder folder;
  folder.write("particle.txt", chainOf(1000));
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_TRUE(terminal >= 0 && grantpt(terminal) == 0 && unlockpt(terminal) == 0);
  const std::string other_end = ptsname(terminal);
  Command command = exercise3(folder, {"Runge-Kutta-4", "--no-frames", "--frames", "1000000000"});
  command.prepare = [&other_end] {
    const int errors = open(other_end.c_str(), O_RDWR | O_NOCTTY);
    if (errors < 0 || dup2(errors, STDERR_FILENO) < 0 || close(errors) != 0) _exit(1);
  };
  Process process(command);
  EXPECT_THAT(readTerminal(terminal, " left\x1b[K"),
              MatchesRegex(".*\r[1-9][0-9]* of 1000000000 frames, 0 %, [0-9.e+]+ per second, "
                           "[1-9][0-9]* s left\x1b.K"));
  process.sendSignal(SIGINT);
  EXPECT_EQ(process.wait().status, 128 + SIGINT);
  EXPECT_THAT(readTerminal(terminal, ""), EndsWith("\r\x1b[K"));
  close(terminal);
}

TEST(Exercise3Output, NoFramesTouchesNothing) {
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  folder.write(frame(0), "earlier\n");
  EXPECT_EQ(run(exercise3(folder, {"Euler", "--no-frames"})).status, 0);
  EXPECT_THAT(listFolder(folder.path()), ElementsAre(frame(0), "particle.txt"));
  EXPECT_EQ(readFile(folder.path(frame(0))), "earlier\n");
}

TEST(Exercise3Output, FolderThatCannotBeUsed) {
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  std::filesystem::create_directory(folder.path("locked"));
  folder.write("locked/" + frame(7), "earlier\n");
  chmod(folder.path("locked").c_str(), 0555);
  std::filesystem::create_symlink("nowhere", folder.path("link"));
  const std::vector<std::pair<std::string, std::string>> cases{
      {"locked", "/locked: could not be written: Permission denied\n"},
      {"locked/new", "/locked/new: could not be created: Permission denied\n"},
      {"particle.txt",
       "/particle.txt: could not be created: it is a file or lies in one; give a folder\n"},
      {"particle.txt/new",
       "/particle.txt/new: could not be created: it is a file or lies in one; give a folder\n"},
      {"link", "/link: could not be created: it is a link to a folder that does not exist\n"},
  };
  for (const auto& [output, message] : cases) {
    Command command = exercise3(folder, {"Euler", "--output", output});
    command.prepare = respectPermissions;
    const Result result = run(command);
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(result.errors, folder.path() + message);
  }
  EXPECT_THAT(listFolder(folder.path()), ElementsAre("link", "locked", "particle.txt"));
  EXPECT_EQ(readFile(folder.path("locked/" + frame(7))), "earlier\n");
}

/// Makes the folder "full" a file system with space for a few frames or, if mounting is not
/// allowed, limits the size of files to that of the first frame.
void fillDisk() {
  if (unshare(CLONE_NEWNS) == 0 && mount("", "/", "", MS_REC | MS_PRIVATE, nullptr) == 0 &&
      mount("tmpfs", "full", "tmpfs", 0, "size=64k") == 0) {
    return;
  }
  const rlimit limit{16384, 16384};
  if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(1);
  signal(SIGXFSZ, SIG_IGN);
}

TEST(Exercise3Output, FullDiskIsToldAndLeavesOnlyWholeFrames) {
  const TemporaryFolder folder;
  folder.write("particle.txt", chainOf(1000));
  std::filesystem::create_directory(folder.path("full"));
  // The disk is gone when the program ends, so the shell looks at it.
  const Result result = run({{"/bin/sh", "-c",
                              "\"$0\" Runge-Kutta-4 --output full; echo \"status $?\"; ls -A full; "
                              "for f in full/*; do "
                              "[ $(wc -l < $f) = 1000 ] || echo \"$f is not whole\"; done",
                              EXERCISE3},
                             folder.path(),
                             {},
                             fillDisk});
  EXPECT_THAT(result.errors,
              MatchesRegex(folder.path("full") + "/frame_000[1-9].txt: could not be written: "
                                                 "(No space left on device|File too large)\n"));
  EXPECT_THAT(result.output, MatchesRegex("status 1\n(frame_000[0-9].txt\n)+"));
}

TEST(Exercise3Output, OneParticleStaysWhereItIs) {
  const TemporaryFolder folder;
  folder.write("particle.txt", "0.1 -2 1\n");
  EXPECT_EQ(run(exercise3(folder, {"Runge-Kutta-4"})).status, 0);
  EXPECT_EQ(readFile(folder.path(frame(499))), "0.1 -2\n");
}

TEST(Exercise3Output, AChainAtRestStaysWhereItHangs) {
  const TemporaryFolder folder;
  folder.write("particle.txt", "0 0 1\n1 0 1\n2 0 2\n");
  EXPECT_EQ(run(exercise3(folder, {"Runge-Kutta-4", "--start", "at_rest"})).errors, "");
  // Springs of 1 m and 50 N/m carry 3 g and 2 g.
  EXPECT_EQ(readFile(folder.path(frame(0))), "0 0\n0 -1.5885999999999998\n0 -2.981\n");
  EXPECT_EQ(readFile(folder.path(frame(499))), readFile(folder.path(frame(0))));
}

TEST(Exercise3Output, HundredThousandParticles) {
  const TemporaryFolder folder;
  folder.write("particle.txt", chainOf(100000));
  const Result result = run(exercise3(folder, {"Euler", "--frames", "2"}));
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, StartsWith("Euler: 100000 particles, 2 frames, 10 steps, "));
  for (const int index : {0, 1}) {
    const std::string text = readFile(folder.path(frame(index)));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 100000);
  }
}

}  // namespace
}  // namespace spring_pendulum
