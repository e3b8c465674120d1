// Notices parameters that are changed while the node runs, and says that they are not used.
#pragma once

#include <ros/time.h>

#include <XmlRpcValue.h>

namespace spring_pendulum {

/// Compares the private parameters with those of the start. The ROS master tells the node of
/// changes, so a look costs no question to the master.
class ParameterWatch {
 public:
  /// Takes the present values as those of the start.
  ParameterWatch();

  /// Looks at most twice per second, and warns once of every new value.
  void look();

 private:
  void compare(XmlRpc::XmlRpcValue& now);

  XmlRpc::XmlRpcValue known_;
  ros::SteadyTime next_look_;
};

}  // namespace spring_pendulum
