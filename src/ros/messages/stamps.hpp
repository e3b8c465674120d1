// The stamps of messages: strictly increasing and never 0, whatever the clock does.
#pragma once

#include <ros/time.h>

namespace spring_pendulum {

class Stamps {
 public:
  /// The stamp of simulated time 0, because 0 is not a valid stamp.
  static ros::Time simulatedStart() { return {1, 0}; }

  /// \param simulated use simulated time instead of ROS time
  explicit Stamps(bool simulated) : simulated_(simulated) {}

  /// \param simulated_time s since the start of the run. If it jumps back (a reset), stamps
  ///   continue from their last value.
  /// \throws InputError if simulated time is too long for a stamp
  ros::Time next(double simulated_time);

 private:
  bool simulated_;
  double last_simulated_time_ = 0.0;
  ros::Time played_ = simulatedStart();  ///< simulated time without the jumps back
  ros::Time last_;
};

}  // namespace spring_pendulum
