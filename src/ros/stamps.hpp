// The stamps of a run's messages: strictly increasing and never 0, whatever the clock does.
#pragma once

#include <ros/time.h>

namespace spring_pendulum {

class Stamps {
 public:
  /// Simulated time 0 is stamped with this, because 0 is no valid stamp.
  static ros::Time simulatedStart() { return {1, 0}; }

  /// \param simulated stamp with simulated instead of ROS time
  explicit Stamps(bool simulated) : simulated_(simulated) {}

  /// \param simulated_time s since the start of the run. When it jumps back (a reset), stamps go on
  ///   from where they are.
  /// \throws InputError if simulated time has become too long for a stamp
  ros::Time next(double simulated_time);

 private:
  bool simulated_;
  double last_simulated_time_ = 0.0;
  ros::Time played_ = simulatedStart();  ///< simulated time without the jumps back
  ros::Time last_;
};

}  // namespace spring_pendulum
