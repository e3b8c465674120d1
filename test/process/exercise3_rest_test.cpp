// `--start at_rest`: a chain that does not move.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

TEST(Exercise3Rest, StaysWhereItHangs) {
  const TemporaryFolder folder;
  folder.write("particle.txt", "0 0 1\n1 0 1\n2 0 2\n");
  const Result result = run(exercise3(folder, {"Runge-Kutta-4", "--start", "at_rest"}));
  EXPECT_EQ(result.errors, "");
  // Springs of 1 m and 50 N/m carry 3 g and 2 g.
  const std::string frame = readFile(folder.path("frame_0499.txt"));
  EXPECT_EQ(frame, readFile(folder.path("frame_0000.txt")));
  EXPECT_EQ(frame, "0 0\n0 -1.5885999999999998\n0 -2.981\n");
}

TEST(Exercise3Rest, NeedsStiffness) {
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  const Result result = run(exercise3(folder, {"Euler", "--start", "at_rest", "--stiffness", "0"}));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, testing::HasSubstr("a chain at rest needs a stiffness above 0 N/m"));
}

TEST(Exercise3Rest, NeedsSpringsWithALength) {
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  const Result result = run(
      exercise3(folder, {"Auto", "--start", "at_rest", "--rest-length", "0", "--gravity", "0"}));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, testing::HasSubstr("a spring of length 0"));
}

TEST(Exercise3Rest, DoesNotResume) {
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  ASSERT_EQ(run(exercise3(folder, {"Euler", "--frames", "2", "--save-state", "state.txt"})).status,
            0);
  const Result result = run(
      exercise3(folder, {"Euler", "--particles", "state.txt", "--resume", "--start", "at_rest"}));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, testing::StartsWith("start: at_rest and resume exclude each other"));
}

}  // namespace
}  // namespace spring_pendulum
