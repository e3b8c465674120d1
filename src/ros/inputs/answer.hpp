// What the node says to its users: answers of services, and log lines that may repeat.
#pragma once

#include <ros/time.h>

#include <exception>

namespace spring_pendulum {

/// Calls a function and answers with its sentence, or with the error.
template <typename Response, typename Function>
bool answer(Response& response, const Function& function) {
  try {
    response.message = function();
    response.success = 1;
  } catch (const std::exception& error) {
    response.message = error.what();
    response.success = 0;
  }
  return true;
}

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
