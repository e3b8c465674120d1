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

  /// Number of subscribers of markers, state and status.
  std::int64_t subscribers() const;
  /// Whether a topic that shows states between the frames has subscribers.
  bool isWatched() const {
    return publishes_clock_ || isSubscribed(markers_) || isSubscribed(state_);
  }
  void freezeCamera(bool freeze) { messages_.freezeCamera(freeze); }
  /// Publishes the messages about the current state.
  /// \returns their header; nothing if the state is not due
  std::optional<std_msgs::Header> publish(const Run& run, Showing showing);
  /// Publishes the status of a node that waits for subscribers.
  void publishWaiting(const std::string& text);
  /// Removes the markers from rviz, which keeps them when the node has ended.
  void clear();
  /// Returns for the closing line: "12 marker and 30 state messages built".
  std::string numbers() const;

 private:
  static bool isSubscribed(const ros::Publisher& topic) { return topic.getNumSubscribers() > 0; }

  bool publishes_clock_;
  RunMessages messages_;
  std::int64_t markers_built_ = 0;
  std::int64_t states_built_ = 0;
  ros::Publisher markers_;
  ros::Publisher state_;
  ros::Publisher status_;
  ros::Publisher clock_;
  ros::Publisher tf_static_;
};

}  // namespace spring_pendulum
