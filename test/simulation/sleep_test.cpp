#include "simulation/sleep.hpp"

#include <gtest/gtest.h>

#include <limits>

#include <support/scenes.hpp>

namespace spring_pendulum {
namespace {

class Sleep : public testing::Test {
 protected:
  Chain chain_{Eigen::VectorXd::Ones(3), SpringLaw{}, 9.81};
  State rest_ = test::hangingAtRest(chain_);
};

TEST_F(Sleep, ChainAtRestIsFoundAndAnythingElseIsNot) {
  EXPECT_TRUE(isAtRest(chain_, rest_, 0.1, 1e-9));
  State moving = rest_;
  moving.vx()[2] = 2e-9;
  EXPECT_FALSE(isAtRest(chain_, moving, 0.1, 1e-9));
  State turning = rest_;  // without speed, but 1e-7 m too low: 50 N/m give 5e-7 m/s in 0.1 s
  turning.y()[2] -= 1e-7;
  EXPECT_FALSE(isAtRest(chain_, turning, 0.1, 1e-9));
  EXPECT_TRUE(isAtRest(chain_, turning, 0.1, 1e-6));
  State lost = rest_;
  lost.x()[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(isAtRest(chain_, lost, 0.1, 1e9));
}

}  // namespace
}  // namespace spring_pendulum
