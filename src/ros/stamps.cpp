#include "ros/stamps.hpp"

#include <algorithm>

namespace spring_pendulum {

ros::Time Stamps::next(double simulated_time) {
  if (simulated_time > last_simulated_time_) {
    played_ += ros::Duration(simulated_time - last_simulated_time_);
  }
  last_simulated_time_ = simulated_time;
  // With use_sim_time and nobody publishing /clock, ROS time stands at 0.
  ros::Time now = simulated_ ? ros::Time() : ros::Time::now();
  if (now.isZero()) now = played_;
  last_ = std::max(now, last_ + ros::Duration(0, 1));
  return last_;
}

}  // namespace spring_pendulum
