// Warns about parameters that change while the node runs, as they have no effect.
#pragma once

#include <ros/time.h>

#include <XmlRpcValue.h>

namespace spring_pendulum {

/// Compares the private parameters with their values at the start. The ROS master sends changes to
/// the node, so this needs no query.
class ParameterWatch {
 public:
  /// Checks at most twice per second, and warns once about each new value.
  void look();

 private:
  XmlRpc::XmlRpcValue known_;  ///< invalid before the first look
  ros::SteadyTime next_look_;
};

}  // namespace spring_pendulum
