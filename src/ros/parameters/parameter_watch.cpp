#include "ros/parameters/parameter_watch.hpp"

#include <ros/console.h>
#include <ros/param.h>
#include <ros/this_node.h>

namespace spring_pendulum {

void ParameterWatch::look() {
  constexpr double kInterval = 0.5;  // s
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (now < next_look_) return;
  next_look_ = now + ros::WallDuration(kInterval);
  XmlRpc::XmlRpcValue values;
  values.begin();  // makes it a map, also if there is no parameter
  ros::param::getCached(ros::this_node::getName(), values);
  if (!known_.valid()) known_ = values;
  for (auto& [key, value] : values) {
    if (known_.hasMember(key) && known_[key] == value) continue;
    ROS_WARN(
        "parameter ~%s was changed while the node runs: this has no effect until the node is "
        "started again; the service ~set changes constants at once",
        key.c_str());
  }
  known_ = values;
}

}  // namespace spring_pendulum
