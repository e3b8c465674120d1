// Output files at unusual paths: only outputs are written, and nothing is lost.
#include "io/files/frame_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kEnergyStart = "frame,time [s],";

class Exercise3Files : public testing::Test {
 protected:
  Exercise3Files() { folder_.write("particle.txt", kTwoParticles); }

  Command command(std::vector<std::string> options) const {
    options.insert(options.begin(), {"Runge-Kutta-4", "--frames", "3"});
    return exercise3(folder_, options);
  }

  void expectRefused(const std::vector<std::string>& options, int status,
                     const std::string& message) const {
    const Result result = run(command(options));
    EXPECT_EQ(result.status, status);
    EXPECT_EQ(result.errors, message + "\n");
    EXPECT_EQ(result.output, "");
  }

  std::string read(const std::string& name) const { return readFile(folder_.path(name)); }

  TemporaryFolder folder_;
};

TEST_F(Exercise3Files, AnInputIsNoOutput) {
  expectRefused({"--energy", "particle.txt"}, 2,
                folder_.path("particle.txt") +
                    ": is an input of this run and would be overwritten; choose another file");
  folder_.write("frame_0012.txt", kTwoParticles);
  expectRefused({"--particles", "frame_0012.txt"}, 2,
                folder_.path("frame_0012.txt") +
                    ": has the name of a frame; choose another folder for the frames");
}

TEST_F(Exercise3Files, AnEnergyFileIsNoFrame) {
  expectRefused(
      {"--energy", "frame_0001.txt", "--output", "out"}, 2,
      folder_.path("frame_0001.txt") + ": is the name of a frame file; give another name");
}

TEST_F(Exercise3Files, ALinkStaysAndItsFileIsWritten) {
  std::filesystem::create_directory(folder_.path("far"));
  folder_.write("far/old.csv", "earlier");
  std::filesystem::create_symlink("far/old.csv", folder_.path("to_old"));
  std::filesystem::create_symlink("to_old", folder_.path("to_link"));
  std::filesystem::create_symlink("far/new.csv", folder_.path("to_nothing"));
  for (const std::string link : {"to_link", "to_nothing"}) {
    EXPECT_EQ(run(command({"--no-frames", "--energy", link})).status, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(folder_.path(link)));
    EXPECT_THAT(read(link), StartsWith(kEnergyStart));
  }
  EXPECT_THAT(listFolder(folder_.path("far")), ElementsAre("new.csv", "old.csv"));
}

TEST_F(Exercise3Files, ALinkToItselfIsRefused) {
  std::filesystem::create_symlink("loop", folder_.path("loop"));
  expectRefused({"--energy", "loop"}, 1,
                folder_.path("loop") + ": could not be written: Too many levels of symbolic links");
}

TEST_F(Exercise3Files, WhatIsInTheWayOfTheHiddenFileIsNotOpened) {
  std::filesystem::create_symlink("particle.txt", folder_.path(".a.csv.tmp"));
  mkfifo(folder_.path(".b.csv.tmp").c_str(), 0600);
  std::filesystem::create_directory(folder_.path(".c.csv.tmp"));
  folder_.write("other", "of somebody");
  std::filesystem::create_hard_link(folder_.path("other"), folder_.path(".d.csv.tmp"));
  for (const std::string name : {"a.csv", "b.csv", "c.csv", "d.csv"}) {
    expectRefused({"--energy", name}, 1,
                  folder_.path(name) + ": needs the name ." + name +
                      ".tmp, which is taken; remove that file");
  }
  EXPECT_EQ(read("particle.txt"), kTwoParticles);
  EXPECT_EQ(read("other"), "of somebody");
}

TEST_F(Exercise3Files, PipesAndStandardStreamsAreRefused) {
  mkfifo(folder_.path("pipe").c_str(), 0600);
  for (const std::string& name : {folder_.path("pipe"), folder_.path(), std::string("/dev/null")}) {
    expectRefused({"--no-frames", "--energy", name}, 1,
                  name + ": is a folder, a pipe or a device; give a regular file");
  }
  const Result result =
      run({{"/bin/sh", "-c", R"("$0" Euler --no-frames --energy /dev/stdout > out.txt)", EXERCISE3},
           folder_.path()});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, StartsWith("/dev/stdout: is a standard stream of this program"));
  EXPECT_EQ(read("out.txt"), "");
}

TEST_F(Exercise3Files, AWriteProtectedEnergyFileStays) {
  folder_.write("e.csv", "precious");
  chmod(folder_.path("e.csv").c_str(), 0444);
  Command disturbed = command({"--energy", "e.csv"});
  disturbed.prepare = respectPermissions;
  const Result result = run(disturbed);
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors, folder_.path("e.csv") + ": could not be written: Permission denied\n");
  EXPECT_EQ(read("e.csv"), "precious");
}

TEST_F(Exercise3Files, DotsAfterALinkMeanTheFolderThatTheLinkLeadsTo) {
  std::filesystem::create_directories(folder_.path("far/away"));
  std::filesystem::create_directories(folder_.path("frames"));
  folder_.write("frames/frame_0000.txt", "not of this run");
  std::filesystem::create_symlink("far/away", folder_.path("link"));
  const Result result = run(command({"--output", "link/../frames"}));
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.output, HasSubstr(" to " + folder_.path("link/../frames")));
  EXPECT_EQ(listFolder(folder_.path("far/frames")).size(), 3U);
  EXPECT_EQ(read("frames/frame_0000.txt"), "not of this run");
}

TEST_F(Exercise3Files, AReplacedEnergyFileKeepsItsPermissions) {
  for (const mode_t mode : {0600U, 0664U}) {
    folder_.write("e.csv", "earlier");
    chmod(folder_.path("e.csv").c_str(), mode);
    ASSERT_EQ(run(command({"--energy", "e.csv"})).status, 0);
    struct stat status {};
    ASSERT_EQ(stat(folder_.path("e.csv").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777U, mode);
    EXPECT_THAT(read("e.csv"), StartsWith(kEnergyStart));
  }
}

// If descriptors 0 to 2 are closed, files of the run must not get them and receive messages.
TEST_F(Exercise3Files, ClosedStandardStreamsChangeNoFile) {
  ASSERT_EQ(run(command({"--output", "expected", "--energy", "expected.csv"})).status, 0);
  for (const char* closed : {"<&-", ">&-", "2>&-", "<&- >&- 2>&-"}) {
    const Result result =
        run({{"/bin/sh", "-c",
              std::string(R"("$0" Runge-Kutta-4 --frames 3 --output out --energy e.csv )") + closed,
              EXERCISE3},
             folder_.path()});
    EXPECT_EQ(result.status, std::string(closed).find(" >&-") == std::string::npos &&
                                     std::string(closed).substr(0, 1) != ">"
                                 ? 0
                                 : 1)
        << closed;
    EXPECT_EQ(read("e.csv"), read("expected.csv"));
    for (const std::string& name : listFolder(folder_.path("expected"))) {
      EXPECT_EQ(read("out/" + name), read("expected/" + name)) << closed;
    }
    std::filesystem::remove_all(folder_.path("out"));
  }
}

/// A run that does not end by itself, with short frames or one endless frame.
class Exercise3Endless : public Exercise3Files {
 protected:
  Command endless(const std::vector<std::string>& options = {}) const {
    std::vector<std::string> all{"--frames", "1000000000", "--output", "out", "--energy", "e.csv"};
    all.insert(all.end(), options.begin(), options.end());
    return command(all);
  }
};

TEST_F(Exercise3Endless, AFolderMovedAwayAndReplacedIsAnError) {
  Process process(endless());
  process.waitForFile(folder_.path("out/frame_0005.txt"));
  std::filesystem::rename(folder_.path("out"), folder_.path("moved"));
  std::filesystem::create_directory(folder_.path("out"));
  process.sendSignal(SIGTERM);
  const Result result = process.wait();
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors,
            folder_.path("out") + ": was moved or removed during the run, and its files with it\n");
  EXPECT_THAT(read("e.csv"), StartsWith(kEnergyStart));
  EXPECT_THAT(listFolder(folder_.path("out")), ElementsAre());
}

TEST_F(Exercise3Endless, ASignalEndsItInsideAFrame) {
  const std::vector<std::string> fixed{"Runge-Kutta-4", "--steps-per-frame", "1000000000000000"};
  const std::vector<std::string> controlled{"Taylor-8", "--frame-interval", "1e6"};
  for (std::vector<std::string> options : {fixed, controlled}) {
    options.insert(options.end(), {"--output", "out", "--energy", "e.csv"});
    const Command disturbed = exercise3(folder_, options);
    for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
      std::filesystem::remove_all(folder_.path("out"));
      Process process(disturbed);
      process.waitForFile(folder_.path("out/frame_0000.txt"));
      process.sendSignal(signal_number);
      const Result result = process.wait();
      EXPECT_EQ(result.status, 128 + signal_number);
      EXPECT_LT(result.seconds_after_signal, 1.0);  // 0.02
      EXPECT_THAT(result.output, HasSubstr(": 2 particles, 1 frame, "));
      EXPECT_THAT(listFolder(folder_.path("out")), ElementsAre("frame_0000.txt"));
      EXPECT_THAT(read("e.csv"), HasSubstr("\n0,0,"));
    }
  }
}

TEST_F(Exercise3Endless, SignalsIgnoredAtTheStartStayIgnored) {
  for (const int signal_number : {SIGINT, SIGHUP}) {
    Command disturbed = endless();
    disturbed.prepare = [signal_number] { signal(signal_number, SIG_IGN); };
    std::filesystem::remove_all(folder_.path("out"));
    Process process(disturbed);
    process.waitForFile(folder_.path("out/frame_0005.txt"));
    process.sendSignal(signal_number);
    const int later = static_cast<int>(listFolder(folder_.path("out")).size()) + 20;
    process.waitForFile(folder_.path("out/" + frameName(later)));
    process.sendSignal(SIGTERM);
    EXPECT_EQ(process.wait().status, 128 + SIGTERM);
  }
}

// The warning is written at once, progress after a second, when the terminal is gone.
TEST_F(Exercise3Endless, AVanishedTerminalDoesNotEndIt) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_TRUE(terminal >= 0 && grantpt(terminal) == 0 && unlockpt(terminal) == 0);
  const std::string other_end = ptsname(terminal);
  Command disturbed = endless({"--time-step", "0.2"});
  disturbed.prepare = [&other_end] {
    const int errors = open(other_end.c_str(), O_RDWR | O_NOCTTY);
    if (errors < 0 || dup2(errors, STDERR_FILENO) < 0 || close(errors) != 0) _exit(1);
  };
  Process process(disturbed);
  process.waitForFile(folder_.path("out/frame_0005.txt"));
  close(terminal);
  sleep(2);
  process.sendSignal(SIGTERM);
  const Result result = process.wait();
  EXPECT_EQ(result.status, 128 + SIGTERM);
  EXPECT_THAT(result.output, HasSubstr(", verdict: "));
}

TEST_F(Exercise3Files, TheEnergyFileMayLieInTheNewFolderOfTheFrames) {
  const Result result = run(command({"--output", "new/frames", "--energy", "new/frames/e.csv"}));
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(listFolder(folder_.path("new/frames")),
              ElementsAre("e.csv", "frame_0000.txt", "frame_0001.txt", "frame_0002.txt"));
  folder_.write("file", "");
  expectRefused({"--energy", "file/e.csv"}, 1,
                folder_.path("file/e.csv") + ": could not be written: Not a directory");
}

// Otherwise a folder name could forge lines, or control the terminal.
TEST_F(Exercise3Files, TheClosingLineIsOneLineWhateverTheNameOfTheFolder) {
  const Result result = run(command({"--output", "a\nb\x1b[31m"}));
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.output, HasSubstr(folder_.path("a?b?[31m")));
  EXPECT_EQ(result.output.find('\n'), result.output.size() - 1);
}

TEST_F(Exercise3Files, AFileLargerThanAllowedIsAnError) {
  Command limited = command({"--no-frames", "--frames", "10000", "--energy", "e.csv"});
  limited.prepare = [] {
    // Of the 1.5 MB that the energy file has. Less would be too little for the counts of a coverage run.
    const rlimit size{1000000, 1000000};
    if (setrlimit(RLIMIT_FSIZE, &size) != 0) _exit(1);
    signal(SIGXFSZ, SIG_DFL);
  };
  const Result result = run(limited);
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors, folder_.path("e.csv") + ": could not be written: File too large\n");
  EXPECT_THAT(listFolder(folder_.path()), ElementsAre("particle.txt"));
}

}  // namespace
}  // namespace spring_pendulum
