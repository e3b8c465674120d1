#include "ros/parameters/parameter_watch.hpp"

#include <ros/console.h>
#include <ros/param.h>
#include <ros/this_node.h>

namespace spring_pendulum {
namespace {

constexpr double kInterval = 0.5;  // s

XmlRpc::XmlRpcValue presentValues() {
  XmlRpc::XmlRpcValue values;
  ros::param::getCached(ros::this_node::getName(), values);
  return values;
}

void warn(const std::string& key, const char* what) {
  ROS_WARN(
      "parameter ~%s was %s while the node runs: this has no effect until the node is started "
      "again",
      key.c_str(), what);
}

}  // namespace

ParameterWatch::ParameterWatch() : known_(presentValues()) {}

void ParameterWatch::look() {
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (now < next_look_) return;
  next_look_ = now + ros::WallDuration(kInterval);
  XmlRpc::XmlRpcValue values = presentValues();
  if (values != known_) compare(values);
}

void ParameterWatch::compare(XmlRpc::XmlRpcValue& now) {
  using XmlRpc::XmlRpcValue;
  if (now.getType() == XmlRpcValue::TypeStruct) {
    const bool had_any = known_.getType() == XmlRpcValue::TypeStruct;
    for (auto& [key, value] : now) {
      if (!had_any || !known_.hasMember(key)) {
        warn(key, "set");
      } else if (known_[key] != value) {
        warn(key, "changed");
      }
    }
  }
  known_ = now;
}

}  // namespace spring_pendulum
