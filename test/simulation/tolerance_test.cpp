#include "simulation/tolerance.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace spring_pendulum {
namespace {

/// Two particles, a metre apart.
std::string messageFor(double tolerance, double place) {
  State state(2);
  state.x() << place, place + 1.0;
  try {
    checkTolerance(tolerance, Chain(Eigen::VectorXd::Ones(2), SpringLaw{}, 9.81), state);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Tolerance, IsAboveTheRoundingOfThePositions) {
  EXPECT_EQ(messageFor(1e-12, 0.0), "");
  EXPECT_THAT(messageFor(1e-300, 0.0),
              testing::StartsWith("tolerance: must be at least 2.3e-13 m"));
  EXPECT_EQ(messageFor(2.3e-13, 0.0), "");
  EXPECT_THAT(messageFor(1e-6, 1e12), testing::StartsWith("tolerance: must be at least 2.3e-02 m"));
  EXPECT_EQ(messageFor(2.3e-2, 1e12), "");
}

}  // namespace
}  // namespace spring_pendulum
