// Simulated time against the wall clock.
#pragma once

#include <ros/time.h>

namespace spring_pendulum {

/// Says when a simulated time is due. A computer that can't keep up falls behind; it does not
/// sprint afterwards.
class Pacer {
 public:
  /// \param factor simulated seconds a second; 0: everything is due at once
  explicit Pacer(double factor) : factor_(factor) {}

  /// From now on `simulated_time` is due now.
  void start(double simulated_time, ros::SteadyTime now);

  bool isStarted() const { return !start_.isZero(); }

  ros::SteadyTime dueTime(double simulated_time) const;
  /// To be called when `simulated_time` is reached.
  void note(double simulated_time, ros::SteadyTime now);
  /// Whether states between the frames should be left out to keep up.
  bool isLate(double simulated_time, ros::SteadyTime now) const;

  /// Simulated seconds a second, measured; 0 before there is a measurement.
  double speed() const { return speed_; }

 private:
  double factor_;
  double start_simulated_ = 0.0;
  ros::SteadyTime start_;
  double measured_simulated_ = 0.0;  ///< where the current measurement of the speed began
  ros::SteadyTime measured_;
  double speed_ = 0.0;
};

}  // namespace spring_pendulum
