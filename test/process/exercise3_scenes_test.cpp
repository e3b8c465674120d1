// Particle files from other systems and programs, and chains of every length.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

using testing::StartsWith;

/// The last frame of a run of `particles`.
std::string lastFrame(const std::string& particles,
                      const std::map<std::string, std::string>& environment = {}) {
  const TemporaryFolder folder;
  folder.write("particle.txt", particles);
  Command command = exercise3(folder, {"Runge-Kutta-4", "--frames", "20", "--time-step", "0.005"});
  command.environment = environment;
  const Result result = run(command);
  EXPECT_EQ(result.status, 0) << result.errors;
  return readFile(folder.path("frame_0019.txt"));
}

constexpr const char* kScene = "0 0 1\n1.5 0.25 1\n2.25 -0.5 0.5\n";

TEST(Exercise3Scenes, EveryWayToWriteAFileGivesTheSameBits) {
  const std::string plain = lastFrame(kScene);
  ASSERT_EQ(std::count(plain.begin(), plain.end(), '\n'), 3);
  EXPECT_EQ(lastFrame("0 0 1\r\n1.5 0.25 1\r\n2.25 -0.5 0.5\r\n"), plain);
  EXPECT_EQ(lastFrame("\xEF\xBB\xBF" + std::string(kScene)), plain);
  EXPECT_EQ(lastFrame("# x y m\n\n0\t0\t1 # fixed\n +1.5 2.5e-1 1\n2.25 -.5 .5"), plain);
}

TEST(Exercise3Scenes, DecimalCommaOfTheLocaleDoesNotMatter) {
  EXPECT_EQ(lastFrame(kScene, {{"LC_ALL", "de_DE.UTF-8"}}), lastFrame(kScene));
}

TEST(Exercise3Scenes, OneParticleStaysWhereItIs) {
  EXPECT_EQ(lastFrame("0.1 -2 1\n"), "0.1 -2\n");
}

TEST(Exercise3Scenes, HundredThousandParticles) {
  const TemporaryFolder folder;
  std::ofstream file(folder.path("particle.txt"));
  for (int i = 0; i < 100000; ++i) file << i << " 0 1\n";
  file.close();
  const Result result = run(exercise3(folder, {"Euler", "--frames", "2"}));
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, StartsWith("Euler: 100000 particles, 2 frames, 10 steps, "));
  for (const char* name : {"frame_0000.txt", "frame_0001.txt"}) {
    const std::string frame = readFile(folder.path(name));
    EXPECT_EQ(std::count(frame.begin(), frame.end(), '\n'), 100000);
  }
}

}  // namespace
}  // namespace spring_pendulum
