// External faults during a run: each ends with one clear line and the right exit status.
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

/// A run of a few seconds that tests disturb.
class Disturbed : public Exercise3Test {
 protected:
  Disturbed() : Exercise3Test(chainOf(1000)) {}

  Command command() const {
    return Exercise3Test::command("Runge-Kutta-4 --output out --frames 20000 --steps-per-frame 1");
  }

  static void expectRefused(const Result& result, const std::string& reason) {
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.errors, HasSubstr("could not be written: " + reason));
    expectOneLine(result.errors);
  }

  const std::string frame_ = path("out/frame_0005.txt");
};

TEST_F(Disturbed, OutputFolderRemoved) {
  Process process(command());
  process.waitForFile(frame_);
  std::error_code error;
  do {
    std::filesystem::remove_all(path("out"), error);
  } while (error);
  expectRefused(process.wait(), "No such file or directory");
}

TEST_F(Disturbed, OutputFolderMadeReadOnly) {
  Command disturbed = command();
  disturbed.prepare = respectPermissions;
  Process process(disturbed);
  process.waitForFile(frame_);
  chmod(path("out").c_str(), 0555);
  const Result result = process.wait();
  chmod(path("out").c_str(), 0755);
  expectRefused(result, "Permission denied");
}

class Exercise3Faults : public Exercise3Test {};

TEST_F(Exercise3Faults, StandardOutputIsLost) {
  Command full = command("Euler --no-frames"), broken = full;
  full.prepare = [] {
    if (dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO) < 0) _exit(126);
  };
  broken.prepare = [] {  // a pipe that nobody reads
    int ends[2];
    if (pipe(ends) != 0 || close(ends[0]) != 0 || dup2(ends[1], STDOUT_FILENO) < 0) _exit(126);
    signal(SIGPIPE, SIG_DFL);
  };
  const std::string message = "standard output: could not be written: ";
  for (const auto& [lost, reason] :
       {std::pair(full, "No space left on device\n"), std::pair(broken, "Broken pipe\n")}) {
    const Result result = run(lost);
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.errors, message + reason);
  }
}

TEST_F(Exercise3Faults, AnExplosionIsFilmedOnlyOnDemandAndOnlyWhileItIsFinite) {
  folder_.write("particle.txt", chainOf(11, "0.01"));
  const Result stopped = runWith("Runge-Kutta-4 --output stopped");
  EXPECT_EQ(stopped.status, 3);
  EXPECT_THAT(stopped.errors, HasSubstr("largest stable step for Runge-Kutta-4: 0.008"));
  EXPECT_EQ(runWith("Runge-Kutta-4 --output filmed --on-divergence continue").status, 3);
  EXPECT_GT(list("filmed").size(), list("stopped").size());
  for (const std::string& name : list("filmed"))
    EXPECT_EQ(read("filmed/" + name).find_first_of("an"), std::string::npos);
}

}  // namespace
}  // namespace spring_pendulum
