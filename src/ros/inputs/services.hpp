// The services of a node: each turns its call into a request and answers with the sentence.
#pragma once

#include "ros/inputs/frames.hpp"
#include "ros/inputs/requests.hpp"

#include <ros/node_handle.h>

#include <vector>

namespace spring_pendulum {

/// \param frames must outlive the services
std::vector<ros::ServiceServer> advertiseServices(ros::NodeHandle& private_node, Frames& frames,
                                                  const RequestHandler& take);

}  // namespace spring_pendulum
