// The services of a node: each turns its call into a request and answers with the sentence.
#pragma once

#include "ros/inputs/frames.hpp"
#include "ros/inputs/requests.hpp"
#include <spring_pendulum/ApplyForce.h>

#include <ros/node_handle.h>

#include <vector>

namespace spring_pendulum {

class Services {
 public:
  /// \param frames must outlive the services
  Services(ros::NodeHandle& private_node, Frames& frames, RequestHandler take);

 private:
  template <typename Service, typename MakeRequest>
  void advertise(ros::NodeHandle& node, const char* name, MakeRequest make_request);
  Request forceRequest(const ApplyForce::Request& call);

  Frames& frames_;
  RequestHandler take_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace spring_pendulum
