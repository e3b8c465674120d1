#include "ros/messages/stamps.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace spring_pendulum {

ros::Time Stamps::next(double simulated_time) {
  constexpr double kLatest = 2e9;  // s; a duration of ROS has 31 bits for them
  const double more = simulated_time - last_simulated_time_;
  const bool fits = played_ + more <= kLatest;
  if (!fits && simulated_)
    throw InputError(
        fmt::format("simulated time {:g} s is too large for ROS time stamps, which end at {:g} s",
                    played_ + more, kLatest));
  if (fits && more > 0.0) played_ += more;
  last_simulated_time_ = simulated_time;
  // With use_sim_time and no publisher of /clock, ROS time is 0.
  ros::Time now = simulated_ ? ros::Time() : ros::Time::now();
  if (now.isZero()) now = ros::Time(played_);
  last_ = std::max(now, last_ + ros::Duration(0, 1));
  return last_;
}

}  // namespace spring_pendulum
