#include "ros/node/pacer.hpp"

#include <algorithm>

namespace spring_pendulum {

constexpr double kLateness = 0.1;  // s, largest delay that the run makes up for

void Pacer::start(double simulated_time, ros::SteadyTime now) {
  start_simulated_ = simulated_time;
  start_ = now;
  next_shown_ = simulated_time;
}

ros::SteadyTime Pacer::dueTime(double simulated_time) const {
  if (factor_ <= 0.0) return start_;
  return start_ +
         ros::WallDuration(std::min((simulated_time - start_simulated_) / factor_, kLongestWait));
}

bool Pacer::isLate(double simulated_time, ros::SteadyTime now) const {
  return factor_ > 0.0 && (now - dueTime(simulated_time)).toSec() > 0.5 * kLateness;
}

bool Pacer::isShown(double simulated_time, bool must) {
  // The states before and after a due time may be unequally far from it: the nearer one is shown.
  if (!must && simulated_time < next_shown_ - 0.5 * shown_interval_) return false;
  next_shown_ += shown_interval_;
  if (next_shown_ <= simulated_time) next_shown_ = simulated_time + shown_interval_;
  return true;
}

void Pacer::reached(double simulated_time, ros::SteadyTime now) {
  if (factor_ > 0.0 && (now - dueTime(simulated_time)).toSec() > kLateness) {
    start_simulated_ = simulated_time;
    start_ = now;
  }
}

}  // namespace spring_pendulum
