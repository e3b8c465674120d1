#include "ros/node/pacer.hpp"

#include <gtest/gtest.h>

namespace spring_pendulum {
namespace {

const ros::SteadyTime kStart(1000.0);

ros::SteadyTime after(double seconds) {
  return kStart + ros::WallDuration(seconds);
}

TEST(Pacer, SimulatedTimeIsDueByTheFactor) {
  Pacer pacer(2.0);
  EXPECT_FALSE(pacer.isStarted());
  pacer.start(10.0, kStart);
  EXPECT_NEAR((pacer.dueTime(13.0) - kStart).toSec(), 1.5, 1e-6);
}

TEST(Pacer, FactorZeroMakesEverythingDueAtOnce) {
  Pacer pacer(0.0);
  pacer.start(0.0, kStart);
  EXPECT_EQ(pacer.dueTime(1e6), kStart);
  EXPECT_FALSE(pacer.isLate(1e6, after(100.0)));
}

TEST(Pacer, CatchesUpWithALittleDelayButNotWithALongOne) {
  Pacer pacer(1.0);
  pacer.start(0.0, kStart);
  pacer.note(1.0, after(1.05));
  EXPECT_NEAR((pacer.dueTime(2.0) - kStart).toSec(), 2.0, 1e-6);
  EXPECT_TRUE(pacer.isLate(1.0, after(1.07)));
  pacer.note(2.0, after(10.0));
  EXPECT_NEAR((pacer.dueTime(3.0) - kStart).toSec(), 11.0, 1e-6);
}

TEST(Pacer, MeasuresItsSpeed) {
  Pacer pacer(3.0);
  pacer.start(0.0, kStart);
  EXPECT_EQ(pacer.speed(), 0.0);
  pacer.note(1.5, after(0.5));
  EXPECT_NEAR(pacer.speed(), 3.0, 1e-5);
}

TEST(Pacer, AWaitThatNoDurationHoldsIsCutShort) {
  Pacer pacer(1e-300);
  pacer.start(0.0, kStart);
  EXPECT_GT(pacer.dueTime(1e6), after(1e8));
}

}  // namespace
}  // namespace spring_pendulum
