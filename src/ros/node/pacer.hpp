// Maps simulated time to wall-clock time, and chooses the states to show.
#pragma once

#include <ros/time.h>

namespace spring_pendulum {

constexpr double kLongestWait = 1e9;  ///< s; ros::Duration has 32 bits for seconds

/// Computes when a simulated time is due. After a delay, the run continues at its speed: it does not catch up.
class Pacer {
 public:
  /// \param factor       simulated seconds per second; 0: every time is due immediately
  /// \param display_rate states shown per second, Hz; 0: all
  Pacer(double factor, double display_rate)
      : factor_(factor), shown_interval_(display_rate > 0.0 ? factor / display_rate : 0.0) {}

  void start(double simulated_time, ros::SteadyTime now);  ///< makes `simulated_time` due now

  ros::SteadyTime dueTime(double simulated_time) const;
  /// Must be called when `simulated_time` is reached.
  void reached(double simulated_time, ros::SteadyTime now);
  /// Whether states between the frames should be left out to keep up.
  bool isLate(double simulated_time, ros::SteadyTime now) const;

  /// Whether `display_rate` asks for a state, or it must be shown. Must be called once per state.
  bool isShown(double simulated_time, bool must = false);

 private:
  double factor_;
  double shown_interval_;    ///< s, simulated time between two shown states; 0: all are shown
  double next_shown_ = 0.0;  ///< s, simulated time
  double start_simulated_ = 0.0;
  ros::SteadyTime start_;
};

}  // namespace spring_pendulum
