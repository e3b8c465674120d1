#include "ros/messages/stamps.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <gtest/gtest.h>

namespace spring_pendulum {
namespace {

TEST(Stamps, SimulatedOnesStartAboveZeroAndFollowSimulatedTime) {
  Stamps stamps(true);
  EXPECT_EQ(stamps.next(0.0), ros::Time(1, 0));
  EXPECT_EQ(stamps.next(0.5), ros::Time(1, 500000000));
  EXPECT_EQ(stamps.next(2.0), ros::Time(3, 0));
}

TEST(Stamps, StrictlyIncreaseWhenTimeStandsOrJumpsBack) {
  Stamps stamps(true);
  ros::Time last;
  for (const double time : {0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.25, 0.1, 0.2, 0.2}) {
    const ros::Time stamp = stamps.next(time);
    EXPECT_GT(stamp, last) << time;
    last = stamp;
  }
  // 1 s, then 0.25 s and 0.1 s after the jumps back, and nanoseconds.
  EXPECT_NEAR(last.toSec(), 1.0 + 1.0 + 0.25 + 0.1, 1e-6);
}

TEST(Stamps, TimesThatDoNotFitAreRefusedWhereTheyAreStamped) {
  Stamps simulated(true);
  EXPECT_EQ(simulated.next(1e9), ros::Time(1000000001, 0));
  EXPECT_THROW(simulated.next(1e10), InputError);
  ros::Time::init();
  ros::Time::setNow(ros::Time(100, 0));
  Stamps real(false);
  EXPECT_EQ(real.next(1e300), ros::Time(100, 0));
}

TEST(Stamps, RosTimeIsTakenAndNeverTurnsBack) {
  ros::Time::init();
  ros::Time::setNow(ros::Time(100, 0));
  Stamps stamps(false);
  EXPECT_EQ(stamps.next(0.0), ros::Time(100, 0));
  ros::Time::setNow(ros::Time(50, 0));
  EXPECT_EQ(stamps.next(0.1), ros::Time(100, 1));
  ros::Time::setNow(ros::Time(200, 0));
  EXPECT_EQ(stamps.next(0.2), ros::Time(200, 0));
}

TEST(Stamps, WithoutARunningClockTheyAreSimulated) {
  ros::Time::init();
  ros::Time::setNow(ros::Time());
  Stamps stamps(false);
  EXPECT_EQ(stamps.next(0.0), ros::Time(1, 0));
  EXPECT_EQ(stamps.next(0.5), ros::Time(1, 500000000));
}

}  // namespace
}  // namespace spring_pendulum
