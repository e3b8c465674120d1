// Log lines that may repeat.
#pragma once

#include <ros/time.h>

namespace spring_pendulum {

/// Limits repeated log lines by the wall clock. The throttled macros of ROS use ROS time, which may stand still.
class Throttle {
 public:
  /// True at most every 5 s.
  bool isDue() {
    const ros::SteadyTime now = ros::SteadyTime::now();
    if (now < next_) return false;
    next_ = now + ros::WallDuration(5.0);
    return true;
  }

 private:
  ros::SteadyTime next_;
};

}  // namespace spring_pendulum
