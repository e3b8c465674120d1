#include "ros/node/pacer.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace spring_pendulum {
namespace {

const ros::SteadyTime kStart(1000.0);

ros::SteadyTime after(double seconds) {
  return kStart + ros::WallDuration(seconds);
}

TEST(Pacer, SimulatedTimeIsDueByTheFactor) {
  Pacer pacer(2.0, 0.0);
  pacer.start(10.0, kStart);
  EXPECT_NEAR((pacer.dueTime(13.0) - kStart).toSec(), 1.5, 1e-6);
  Pacer at_once(0.0, 0.0);
  at_once.start(0.0, kStart);
  EXPECT_TRUE(at_once.dueTime(1e6) == kStart && !at_once.isLate(1e6, after(100.0)));
}

TEST(Pacer, CatchesUpWithALittleDelayButNotWithALongOne) {
  Pacer pacer(1.0, 0.0);
  pacer.start(0.0, kStart);
  pacer.reached(1.0, after(1.05));
  EXPECT_NEAR((pacer.dueTime(2.0) - kStart).toSec(), 2.0, 1e-6);
  EXPECT_TRUE(pacer.isLate(1.0, after(1.07)));
  pacer.reached(2.0, after(10.0));
  EXPECT_NEAR((pacer.dueTime(3.0) - kStart).toSec(), 11.0, 1e-6);
}

TEST(Pacer, AWaitThatNoDurationHoldsIsCutShort) {
  Pacer pacer(1e-300, 0.0);
  pacer.start(0.0, kStart);
  EXPECT_GT(pacer.dueTime(1e6), after(1e8));
}

/// Returns how many of the states at these times within one second of motion are shown.
int shown(Pacer& pacer, const std::vector<double>& times) {
  int count = 0;
  pacer.start(0.0, kStart);
  for (int frame = 0; frame < 10; ++frame)
    for (const double time : times) count += pacer.isShown(0.1 * frame + time) ? 1 : 0;
  return count;
}

TEST(Pacer, ShowsAsManyStatesAsTheDisplayRateAsksFor) {
  for (const double rate : {20.0, 25.0, 30.0, 35.0, 40.0}) {
    Pacer pacer(1.0, rate);
    EXPECT_NEAR(shown(pacer, {0.025, 0.05, 0.075, 0.1}), rate, 1.0) << rate;  // Auto
  }
  Pacer uneven(1.0, 30.0);
  EXPECT_EQ(shown(uneven, {0.03, 0.06, 0.1}), 30) << "three parts of ten steps: all are shown";
  Pacer fast(100.0, 300.0);
  EXPECT_NEAR(shown(fast, {0.1}), 3, 1) << "a second of motion takes 0.01 s";
  Pacer all(1.0, 0.0);
  EXPECT_EQ(shown(all, {0.001, 0.002, 0.1}), 30);
}

TEST(Pacer, ShowsNoBurstAfterAJump) {
  Pacer pacer(1.0, 10.0);
  pacer.start(0.0, kStart);
  EXPECT_TRUE(pacer.isShown(50.0) && !pacer.isShown(50.01) && pacer.isShown(50.1));
}

}  // namespace
}  // namespace spring_pendulum
