// The topics of a node: markers, state, status, the transform of the camera, and optionally /clock.
#pragma once

#include "ros/messages/run_messages.hpp"

#include <ros/node_handle.h>

#include <cstdint>
#include <optional>
#include <string>

namespace spring_pendulum {

class Publisher {
 public:
  Publisher(ros::NodeHandle& node, const Run& run, const NodeOptions& options);

  /// Number of subscribers of markers, state and status in nodes with these names; empty: in all.
  std::int64_t subscribers(const std::string& nodes) const;
  /// Publishes the messages about the current state, if it is due, and returns their header.
  std::optional<std_msgs::Header> publish(const Run& run, Showing showing);
  void publishWaiting(const std::string& text);  ///< the status of a node that waits
  /// Whether a subscriber has yet to get the last markers or state.
  bool isSending() const {
    return last_markers_.buf.use_count() > 1 || last_state_.buf.use_count() > 1;
  }
  void clear();  ///< removes the markers from rviz, which keeps them when the node has ended
  /// Returns for the closing line: "12 marker and 30 state messages built".
  std::string numbers() const;

 private:
  RunMessages messages_;
  std::int64_t markers_built_ = 0, states_built_ = 0;
  ros::SerializedMessage last_markers_, last_state_;  ///< shared with ROS until they are sent
  ros::Publisher markers_, state_, status_, clock_, tf_static_;
};

}  // namespace spring_pendulum
