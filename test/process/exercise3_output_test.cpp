// Exercise3 leaves complete frames of this run in a folder, and all files of others.
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <sys/resource.h>
#include <unistd.h>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

std::string frame(int index) {
  std::string number = std::to_string(index);
  number.insert(0, number.size() < 4 ? 4 - number.size() : 0, '0');
  return "frame_" + number + ".txt";
}

/// A chain for a run of a few tenths of a second, and a run that does not end by itself.
class LongRun : public Exercise3Test {
 protected:
  static constexpr int kFrames = 200;
  static constexpr int kEndless = 1000000;

  LongRun() : Exercise3Test(chainOf(2000)) {}

  Command command(const std::string& output, int frames = kFrames) const {
    return exercise3(folder_, {"Euler", "--output", output, "--frames", std::to_string(frames),
                               "--time-step", "0.001"});
  }

  int countFrames(const std::string& output) const {
    const std::vector<std::string> names = list(output);
    return static_cast<int>(std::count_if(names.begin(), names.end(), [](const auto& name) {
      return name.substr(0, 6) == "frame_";
    }));
  }

  /// The existing frames are those of a run that was not stopped.
  void expectWholeFrames(const std::string& output, const std::string& complete) const {
    const int count = std::min(countFrames(output), kFrames);
    for (int i = 0; i < count; ++i)
      ASSERT_EQ(read(output + "/" + frame(i)), read(complete + "/" + frame(i))) << i;
  }
};

TEST_F(LongRun, KilledAtAnyTimeLeavesOnlyWholeFrames) {
  ASSERT_EQ(run(command("complete")).status, 0);
  for (int attempt = 0; attempt < 20; ++attempt) {
    const std::string killed = "killed" + std::to_string(attempt);
    Process process(command(killed, kEndless));
    process.waitForFile(path(killed + "/" + frame(5 * attempt)));
    usleep(100U * static_cast<unsigned>(attempt));  // in another phase of writing each time
    process.sendSignal(SIGKILL);
    ASSERT_EQ(process.wait().status, 128 + SIGKILL);
    expectWholeFrames(killed, "complete");
  }
}

TEST_F(LongRun, ASecondRunIntoTheSameFolderIsRefused) {
  Process first(command("shared"));
  first.waitForFile(path("shared/" + frame(0)));
  first.sendSignal(SIGSTOP);  // it still exists when the second one starts
  const Result second = run(command("shared", 1));
  EXPECT_EQ(second.status, 1);
  EXPECT_EQ(second.errors,
            path("shared") + ": another run is writing here; use a different path for each run\n");
  first.sendSignal(SIGCONT);
  EXPECT_EQ(first.wait().status, 0);
  EXPECT_EQ(countFrames("shared"), kFrames);
  EXPECT_EQ(run(command("shared", 1)).status, 0);
  EXPECT_EQ(countFrames("shared"), 1);
}

class Exercise3Output : public Exercise3Test {};

TEST_F(Exercise3Output, FiveHundredFramesByDefault) {
  const Result result = runWith("Runge-Kutta-4");
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.errors, "");
  EXPECT_THAT(result.output,
              MatchesRegex("Runge-Kutta-4: 2 particles, 500 frames, 4990 steps, 19960 force "
                           "evaluations, [0-9.]+ m?s integrating, [0-9.]+ m?s writing to " +
                           folder_.path() + ".*\n"));
  EXPECT_EQ(list().size(), 501U);
  EXPECT_EQ(read(frame(0)), "0 0\n1 0\n");
  EXPECT_TRUE(std::filesystem::exists(path(frame(499))));
}

TEST_F(Exercise3Output, AnUnstableTimeStepIsAWarningAtTheStart) {
  const Result result = runWith("Runge-Kutta-4 --no-frames --time-step=9");
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(
      result.errors,
      MatchesRegex("warning: Runge-Kutta-4 may be unstable with a time step of 9 s; .*or use "
                   "Auto\ndiverged at t = .*; largest stable step .*\n"));
}

TEST_F(Exercise3Output, EnergiesHaveARowPerFrameUnderAHeaderWithUnits) {
  folder_.write("particle.txt", "0 0 1 0 0\n0 -2 1 3 0\n");
  ASSERT_EQ(runWith("Auto --no-frames --frames 2 --gravity 10 --energy e.csv").errors, "");
  EXPECT_THAT(read("e.csv"),
              StartsWith("frame,time [s],kinetic [J],gravity [J],spring [J],total [J],dissipated "
                         "[J],residual [J],residual/scale [1],position error [m]\n"
                         "0,0,4.5,-20,25,9.5,0,0,0,0\n1,0.1,"));
}

TEST_F(Exercise3Output, StaleFramesGoAndNothingElse) {
  const std::vector<std::string> kept{"frame_12.txt",    "frame_0001.txt.bak", "frame_000a.txt",
                                      "xframe_0001.txt", "frame_0001.csv",     "frame_.txt",
                                      "frame_-0001.txt", "Frame_0001.txt",     "notes.txt"};
  for (const std::string& name : kept) folder_.write(name, "kept\n");
  for (const int stale : {0, 1, 5, 9999, 10000, 123456789}) folder_.write(frame(stale), "stale\n");
  EXPECT_THAT(runWith("Euler --frames 2").output,
              HasSubstr(" to " + folder_.path() + " (6 earlier frames removed), "));
  for (const std::string& name : kept) EXPECT_EQ(read(name), "kept\n") << name;
  EXPECT_EQ(list().size(), kept.size() + 3);
  EXPECT_EQ(read(frame(0)), "0 0\n1 0\n");
}

TEST_F(Exercise3Output, WhatIsNoFileIsNeverRemoved) {
  folder_.write(frame(0), "earlier\n");
  std::filesystem::create_directory(path(frame(3)));
  const Result result = runWith("Euler");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, StartsWith(path(frame(3)) + ": has the name of a frame file but is "
                                                         "not a regular file"));
  EXPECT_EQ(read(frame(0)), "earlier\n");
}

TEST_F(Exercise3Output, FileLargerThanAllowedIsToldAndLeavesOnlyWholeFrames) {
  folder_.write("particle.txt", chainOf(1000));
  Command limited = command("Runge-Kutta-4 --output full");
  limited.prepare = [] {
    const rlimit size{16384, 16384};  // more than the first frame, less than those with all digits
    if (setrlimit(RLIMIT_FSIZE, &size) != 0) _exit(1);
    signal(SIGXFSZ, SIG_DFL);
  };
  const Result result = run(limited);
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, MatchesRegex(path("full") + "/frame_000[1-9].txt: could not be "
                                                         "written: File too large\n"));
  for (const std::string& name : list("full")) {
    const std::string text = read("full/" + name);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1000) << name;
  }
}

TEST_F(Exercise3Output, AChainAtRestStaysWhereItHangs) {
  folder_.write("particle.txt", "0 0 1\n1 0 1\n2 0 2\n");
  EXPECT_EQ(runWith("Runge-Kutta-4 --start at_rest").errors, "");
  // Springs of 1 m and 50 N/m carry 3 g and 2 g.
  EXPECT_EQ(read(frame(0)), "0 0\n0 -1.5885999999999998\n0 -2.981\n");
  EXPECT_EQ(read(frame(499)), read(frame(0)));
}

}  // namespace
}  // namespace spring_pendulum
