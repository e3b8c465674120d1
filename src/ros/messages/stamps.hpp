// The stamps of messages, strictly increasing and never 0 whatever the clock does; and repeated log lines.
#pragma once

#include <ros/time.h>

namespace spring_pendulum {

class Stamps {
 public:
  /// \param simulated use simulated time instead of ROS time
  explicit Stamps(bool simulated) : simulated_(simulated) {}

  /// \param simulated_time s since the start of the run; after a reset, stamps go on from the last one
  /// \throws InputError if simulated time is too long for a stamp
  ros::Time next(double simulated_time);

 private:
  bool simulated_;
  double last_simulated_time_ = 0.0;
  double played_ = 1.0;  ///< simulated time without the jumps back, s; 0 is not a valid stamp
  ros::Time last_;
};

/// Limits repeated log lines by the wall clock. The macros of ROS use ROS time, which may stand still.
class Throttle {
 public:
  /// True at most every so many seconds.
  bool isDue(double interval = 5.0) {
    const ros::SteadyTime now = ros::SteadyTime::now();
    if (now < next_) return false;
    next_ = now + ros::WallDuration(interval);
    return true;
  }

 private:
  ros::SteadyTime next_;
};

}  // namespace spring_pendulum
