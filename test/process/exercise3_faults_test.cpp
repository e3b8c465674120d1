// External faults during a run: each ends with one clear line and the right exit status.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <sys/resource.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

void expectOneLine(const std::string& text) {
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  EXPECT_EQ(text.back(), '\n');
}

/// A run of a few seconds that tests disturb.
class Disturbed : public testing::Test {
 protected:
  Disturbed() { folder_.write("particle.txt", chainOf(1000)); }

  Command command(std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {"Runge-Kutta-4", "--output", "out", "--frames", "20000",
                                     "--steps-per-frame", "1"});
    return exercise3(folder_, options);
  }

  static constexpr const char* kFrame = "out/frame_0005.txt";

  TemporaryFolder folder_;
};

TEST_F(Disturbed, OutputFolderRemoved) {
  Process process(command());
  process.waitForFile(folder_.path(kFrame));
  std::error_code error;
  do {
    std::filesystem::remove_all(folder_.path("out"), error);
  } while (error);
  const Result result = process.wait();
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, HasSubstr("could not be written: No such file or directory"));
  expectOneLine(result.errors);
}

TEST_F(Disturbed, OutputFolderMadeReadOnly) {
  Command disturbed = command();
  disturbed.prepare = respectPermissions;
  Process process(disturbed);
  process.waitForFile(folder_.path(kFrame));
  chmod(folder_.path("out").c_str(), 0555);
  const Result result = process.wait();
  chmod(folder_.path("out").c_str(), 0755);
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, HasSubstr("could not be written: Permission denied"));
  expectOneLine(result.errors);
}

TEST_F(Disturbed, ParticleFileReplacedDuringTheRunDoesNotMatter) {
  const std::vector<std::string> options{"Runge-Kutta-4", "--frames", "300", "--output"};
  std::vector<std::string> first = options;
  first.emplace_back("out");
  Process process(exercise3(folder_, first));
  process.waitForFile(folder_.path(kFrame));
  folder_.write("particle.txt", "no particles");
  EXPECT_EQ(process.wait().status, 0);
  folder_.write("particle.txt", chainOf(1000));
  std::vector<std::string> second = options;
  second.emplace_back("undisturbed");
  ASSERT_EQ(run(exercise3(folder_, second)).status, 0);
  EXPECT_EQ(readFile(folder_.path("out/frame_0299.txt")),
            readFile(folder_.path("undisturbed/frame_0299.txt")));
}

TEST(Exercise3Faults, ParticleFileChangedWhileReadIsReadOrRefused) {
  const TemporaryFolder folder;
  std::atomic<bool> stop{false};
  std::thread changer([&] {
    for (int length = 1; !stop; length = length % 3000 + 7) {
      folder.write("particle.txt", chainOf(length));
    }
  });
  for (int attempt = 0; attempt < 30; ++attempt) {
    const Result result = run(exercise3(folder, {"Euler", "--no-frames", "--frames", "2"}));
    EXPECT_THAT(result.status, AnyOf(0, 1, 2));
    if (result.status != 0) expectOneLine(result.errors);
  }
  stop = true;
  changer.join();
}

TEST(Exercise3Faults, ReaderOfTheClosingLineGoneAway) {
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  const Result result =
      run({{"/bin/sh", "-c", R"({ "$0" Euler --no-frames; echo "status $?" >&2; } | :)", EXERCISE3},
           folder.path(),
           {},
           [] { signal(SIGPIPE, SIG_DFL); }});
  // The pipe may still be open when the line is written: then nothing went wrong.
  EXPECT_THAT(result.errors,
              AnyOf(HasSubstr("standard output: could not be written: Broken pipe\nstatus 1\n"),
                    HasSubstr("status 0\n")));
}

TEST(Exercise3Faults, NoFileDescriptorLeft) {
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  for (const rlim_t limit : {4U, 5U, 6U}) {  // three are open already, and one loads the libraries
    Command command = exercise3(folder, {"Runge-Kutta-4", "--output", "out", "--energy", "e.csv"});
    command.prepare = [limit] {
      for (int file = 3; file < 1024; ++file) close(file);  // what the test itself inherited
      const rlimit files{limit, limit};
      if (setrlimit(RLIMIT_NOFILE, &files) != 0) _exit(1);
    };
    const Result result = run(command);
    if (result.status == 0) continue;
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.errors, HasSubstr("Too many open files"));
    expectOneLine(result.errors);
  }
}

TEST(Exercise3Faults, MoreParticlesThanMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need more address space than the limit leaves";
#endif
  const TemporaryFolder folder;
  folder.write("particle.txt", chainOf(1000000));
  Command command = exercise3(folder, {"Runge-Kutta-4"});
  command.prepare = [] {
    const rlimit memory{60U << 20U, 60U << 20U};
    if (setrlimit(RLIMIT_AS, &memory) != 0) _exit(1);
  };
  const Result result = run(command);
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors, "not enough memory for a chain of this length\n");
  EXPECT_EQ(listFolder(folder.path()), std::vector<std::string>{"particle.txt"});
}

TEST(Exercise3Faults, AnExplosionIsFilmedOnlyOnDemandAndOnlyWhileItIsFinite) {
  const TemporaryFolder folder;
  folder.write("particle.txt", chainOf(11, "0.01"));
  const Result stopped = run(exercise3(folder, {"Runge-Kutta-4", "--output", "stopped"}));
  const Result filmed = run(
      exercise3(folder, {"Runge-Kutta-4", "--output", "filmed", "--on-divergence", "continue"}));
  EXPECT_EQ(stopped.status, 3);
  EXPECT_EQ(filmed.status, 3);
  EXPECT_THAT(stopped.errors, HasSubstr("largest stable step for Runge-Kutta-4: 0.008"));
  const std::vector<std::string> short_film = listFolder(folder.path("stopped"));
  const std::vector<std::string> film = listFolder(folder.path("filmed"));
  EXPECT_GT(film.size(), short_film.size());
  for (const std::string& name : film) {
    EXPECT_EQ(readFile(folder.path("filmed/" + name)).find_first_of("an"), std::string::npos);
  }
}

}  // namespace
}  // namespace spring_pendulum
