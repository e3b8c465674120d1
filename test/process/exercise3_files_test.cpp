// Output files at unusual paths: only outputs are written, and nothing is lost.
#include "io/files/frame_folder.hpp"

#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

constexpr const char* kEnergyStart = "frame,time [s],";

class Exercise3Files : public Exercise3Test {
 protected:
  Command command(const std::string& options) const {
    return Exercise3Test::command("Runge-Kutta-4 --frames 3 " + options);
  }
};

TEST_F(Exercise3Files, WhatCannotBeAnOutputIsRefused) {
  folder_.write("frame_0012.txt", kTwoParticles);
  folder_.write("file", "");
  folder_.write("protected", "precious");
  folder_.write("other", "of somebody");
  chmod(path("protected").c_str(), 0444);
  mkfifo(path("pipe").c_str(), 0600);
  std::filesystem::create_symlink("loop", path("loop"));
  std::filesystem::create_symlink("particle.txt", path(".a.csv.tmp"));
  mkfifo(path(".b.csv.tmp").c_str(), 0600);
  std::filesystem::create_directory(path(".c.csv.tmp"));
  std::filesystem::create_hard_link(path("other"), path(".d.csv.tmp"));
  std::filesystem::create_directory(path("locked"));
  folder_.write("locked/frame_0007.txt", "earlier\n");
  chmod(path("locked").c_str(), 0555);
  std::filesystem::create_symlink("nowhere", path("link"));
  const std::string no_folder =
      ": could not be created: it is a file or lies in one; give a folder";
  const std::string special = ": is a folder, a pipe or a device; give a regular file";
  const auto taken = [](const std::string& name) {
    return ": needs the name ." + name + ".tmp, which is taken; remove that file";
  };
  const struct {
    std::string options;
    int status;
    std::string path;
    std::string message;
  } rows[] = {
      {"--energy particle.txt", 2, path("particle.txt"),
       ": is an input of this run and would be overwritten; choose another file"},
      {"--particles frame_0012.txt", 2, path("frame_0012.txt"),
       ": has the name of a frame; choose another folder for the frames"},
      {"--energy frame_0001.txt --output out", 2, path("frame_0001.txt"),
       ": is the name of a frame file; give another name"},
      {"--energy loop", 1, path("loop"),
       ": could not be written: Too many levels of symbolic links"},
      {"--energy file/e.csv", 1, path("file/e.csv"), ": could not be written: Not a directory"},
      {"--energy protected", 1, path("protected"), ": could not be written: Permission denied"},
      {"--no-frames --energy pipe", 1, path("pipe"), special},
      {"--no-frames --energy " + folder_.path(), 1, folder_.path(), special},
      {"--no-frames --energy /dev/null", 1, "/dev/null", special},
      {"--energy a.csv", 1, path("a.csv"), taken("a.csv")},
      {"--energy b.csv", 1, path("b.csv"), taken("b.csv")},
      {"--energy c.csv", 1, path("c.csv"), taken("c.csv")},
      {"--energy d.csv", 1, path("d.csv"), taken("d.csv")},
      {"--output locked", 1, path("locked"), ": could not be written: Permission denied"},
      {"--output locked/new", 1, path("locked/new"), ": could not be created: Permission denied"},
      {"--output particle.txt", 1, path("particle.txt"), no_folder},
      {"--output particle.txt/new", 1, path("particle.txt/new"), no_folder},
      {"--output link", 1, path("link"),
       ": could not be created: it is a link to a folder that does not exist"},
  };
  for (const auto& row : rows) {
    Command refused = command(row.options);
    refused.prepare = respectPermissions;
    const Result result = run(refused);
    EXPECT_EQ(result.status, row.status) << row.options;
    EXPECT_EQ(result.errors, row.path + row.message + "\n");
    EXPECT_EQ(result.output, "");
  }
  EXPECT_EQ(read("particle.txt"), kTwoParticles);
  EXPECT_EQ(read("other"), "of somebody");
  EXPECT_EQ(read("protected"), "precious");
  EXPECT_EQ(read("locked/frame_0007.txt"), "earlier\n");
}

TEST_F(Exercise3Files, AStandardStreamIsNoOutput) {
  const Result result =
      run({{"/bin/sh", "-c", R"("$0" Euler --no-frames --energy /dev/stdout > out.txt)", EXERCISE3},
           folder_.path()});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, StartsWith("/dev/stdout: is a standard stream of this program"));
  EXPECT_EQ(read("out.txt"), "");
}

TEST_F(Exercise3Files, ALinkStaysAndItsFileIsWritten) {
  std::filesystem::create_directory(path("far"));
  folder_.write("far/old.csv", "earlier");
  std::filesystem::create_symlink("far/old.csv", path("to_old"));
  std::filesystem::create_symlink("to_old", path("to_link"));
  std::filesystem::create_symlink("far/new.csv", path("to_nothing"));
  for (const std::string link : {"to_link", "to_nothing"}) {
    EXPECT_EQ(run(command("--no-frames --energy " + link)).status, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(path(link)));
    EXPECT_THAT(read(link), StartsWith(kEnergyStart));
  }
  EXPECT_THAT(list("far"), testing::ElementsAre("new.csv", "old.csv"));
}

TEST_F(Exercise3Files, DotsAfterALinkMeanTheFolderThatTheLinkLeadsTo) {
  std::filesystem::create_directories(path("far/away"));
  std::filesystem::create_directories(path("frames"));
  folder_.write("frames/frame_0000.txt", "not of this run");
  std::filesystem::create_symlink("far/away", path("link"));
  const Result result = run(command("--output link/../frames"));
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.output, HasSubstr(" to " + path("link/../frames")));
  EXPECT_EQ(list("far/frames").size(), 3U);
  EXPECT_EQ(read("frames/frame_0000.txt"), "not of this run");
}

TEST_F(Exercise3Files, AReplacedEnergyFileKeepsItsPermissions) {
  for (const mode_t mode : {0600U, 0664U}) {
    folder_.write("e.csv", "earlier");
    chmod(path("e.csv").c_str(), mode);
    ASSERT_EQ(run(command("--energy e.csv")).status, 0);
    struct stat status {};
    ASSERT_EQ(stat(path("e.csv").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777U, mode);
    EXPECT_THAT(read("e.csv"), StartsWith(kEnergyStart));
  }
}

// If descriptors 0 to 2 are closed, files of the run must not get them and receive messages.
TEST_F(Exercise3Files, ClosedStandardStreamsChangeNoFile) {
  ASSERT_EQ(run(command("--output expected --energy expected.csv")).status, 0);
  const std::pair<std::string, int> rows[] = {
      {"<&-", 0}, {">&-", 1}, {"2>&-", 0}, {"<&- >&- 2>&-", 1}};
  for (const auto& [closed, status] : rows) {
    const Result result =
        run({{"/bin/sh", "-c",
              R"("$0" Runge-Kutta-4 --frames 3 --output out --energy e.csv )" + closed, EXERCISE3},
             folder_.path()});
    EXPECT_EQ(result.status, status) << closed;
    EXPECT_EQ(read("e.csv"), read("expected.csv"));
    for (const std::string& name : list("expected"))
      EXPECT_EQ(read("out/" + name), read("expected/" + name)) << closed;
    std::filesystem::remove_all(path("out"));
  }
}

TEST_F(Exercise3Files, TheEnergyFileMayLieInTheNewFolderOfTheFrames) {
  EXPECT_EQ(run(command("--output new/frames --energy new/frames/e.csv")).errors, "");
  EXPECT_THAT(list("new/frames"),
              testing::ElementsAre("e.csv", "frame_0000.txt", "frame_0001.txt", "frame_0002.txt"));
}

/// A run that does not end by itself.
class Exercise3Endless : public Exercise3Files {
 protected:
  Command endless(const std::string& options = "") const {
    return Exercise3Test::command("Runge-Kutta-4 --frames 1000000000 --output out --energy e.csv " +
                                  options);
  }
};

TEST_F(Exercise3Endless, AFolderMovedAwayAndReplacedIsAnError) {
  Process process(endless());
  process.waitForFile(path("out/frame_0005.txt"));
  std::filesystem::rename(path("out"), path("moved"));
  std::filesystem::create_directory(path("out"));
  process.sendSignal(SIGTERM);
  const Result result = process.wait();
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, HasSubstr("out: was moved or removed during the run, and its files"));
  EXPECT_THAT(read("e.csv"), StartsWith(kEnergyStart));
  EXPECT_THAT(list("out"), testing::ElementsAre());
}

TEST_F(Exercise3Endless, ASignalEndsItInsideAFrame) {
  for (const std::string options :
       {"Runge-Kutta-4 --steps-per-frame 1000000000000000", "Taylor-8 --frame-interval 1e6"}) {
    for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
      std::filesystem::remove_all(path("out"));
      Process process(Exercise3Test::command(options + " --output out --energy e.csv"));
      process.waitForFile(path("out/frame_0000.txt"));
      process.sendSignal(signal_number);
      const Result result = process.wait();
      EXPECT_EQ(result.status, 128 + signal_number);
      EXPECT_LT(result.seconds_after_signal, 1.0);  // 0.02
      EXPECT_THAT(result.output, HasSubstr(": 2 particles, 1 frame, "));
      EXPECT_THAT(list("out"), testing::ElementsAre("frame_0000.txt"));
      EXPECT_THAT(read("e.csv"), HasSubstr("\n0,0,"));
    }
  }
}

TEST_F(Exercise3Endless, SignalsIgnoredAtTheStartStayIgnored) {
  for (const int signal_number : {SIGINT, SIGHUP}) {
    Command disturbed = endless();
    disturbed.prepare = [signal_number] { signal(signal_number, SIG_IGN); };
    std::filesystem::remove_all(path("out"));
    Process process(disturbed);
    process.waitForFile(path("out/frame_0005.txt"));
    process.sendSignal(signal_number);
    process.waitForFile(path("out/" + frameName(static_cast<int>(list("out").size()) + 20)));
    process.sendSignal(SIGTERM);
    EXPECT_EQ(process.wait().status, 128 + SIGTERM);
  }
}

/// A terminal on which a program prints its errors.
struct Terminal {
  int end = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);

  void connect(Command& command) const {
    ASSERT_TRUE(end >= 0 && grantpt(end) == 0 && unlockpt(end) == 0);
    command.prepare = [other_end = std::string(ptsname(end))] {
      const int errors = open(other_end.c_str(), O_RDWR | O_NOCTTY);
      if (errors < 0 || dup2(errors, STDERR_FILENO) < 0 || close(errors) != 0) _exit(1);
    };
  }

  /// Reads until the program ends, or until the text contains `wanted`.
  std::string read(const std::string& wanted) const {
    std::string text;
    for (char letter = 0; ::read(end, &letter, 1) == 1;) {
      text += letter;
      if (!wanted.empty() && text.find(wanted) != std::string::npos) break;
    }
    return text;
  }
};

TEST_F(Exercise3Endless, ATerminalIsToldHowFarItIs) {
  const Terminal terminal;
  Command told = Exercise3Test::command("Runge-Kutta-4 --frames 1000000000 --no-frames");
  terminal.connect(told);
  Process process(told);
  EXPECT_THAT(terminal.read(" left\x1b[K"),
              MatchesRegex(".*\r[1-9][0-9]* of 1000000000 frames, 0 %, [0-9.e+]+ per second, "
                           "[1-9][0-9.e+]* s left\x1b.K"));
  process.sendSignal(SIGINT);
  EXPECT_EQ(process.wait().status, 128 + SIGINT);
  EXPECT_THAT(terminal.read(""), testing::EndsWith("\r\x1b[K"));
  close(terminal.end);
}

// The warning is written at once, progress after a second, when the terminal is gone.
TEST_F(Exercise3Endless, AVanishedTerminalDoesNotEndIt) {
  const Terminal terminal;
  Command disturbed = endless("--time-step 0.2");
  terminal.connect(disturbed);
  Process process(disturbed);
  process.waitForFile(path("out/frame_0005.txt"));
  close(terminal.end);
  sleep(2);
  process.sendSignal(SIGTERM);
  const Result result = process.wait();
  EXPECT_EQ(result.status, 128 + SIGTERM);
  EXPECT_THAT(result.output, HasSubstr(", verdict: "));
}

// Otherwise a name could forge lines, or control the terminal.
TEST_F(Exercise3Files, AnyNameMakesOneLine) {
  const Result result = run(command("--output a\nb\x1b[31m"));
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.output, HasSubstr(path("a?b?[31m")));
  expectOneLine(result.output);
}

}  // namespace
}  // namespace spring_pendulum
