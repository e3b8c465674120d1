// Services that change a run while it runs: constants, forces, rest.
#pragma once

#include "ros/inputs/frames.hpp"
#include "ros/inputs/holders.hpp"
#include "ros/parameters/node_options.hpp"
#include <spring_pendulum/ApplyForce.h>
#include <spring_pendulum/Set.h>

#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <string>

namespace spring_pendulum {

class Commands {
 public:
  /// \param set_speed sets the real-time factor
  /// \param show      shows the state again soon
  Commands(ros::NodeHandle& private_node, const Run& run, const NodeOptions& options,
           Holders& holders, Frames& frames, std::function<void(double)> set_speed,
           std::function<void()> show);

 private:
  bool onSet(Set::Request& request, Set::Response& response);
  bool onApplyForce(ApplyForce::Request& request, ApplyForce::Response& response);
  bool onClearForces(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onAtRest(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  std::string set(const std::string& name, const std::string& value);
  std::string applyForce(const ApplyForce::Request& request);

  const Run& run_;
  NodeOptions options_;
  Holders& holders_;
  Frames& frames_;
  std::function<void(double)> set_speed_;
  std::function<void()> show_;
  ros::ServiceServer set_service_, force_, clear_, at_rest_;
};

}  // namespace spring_pendulum
