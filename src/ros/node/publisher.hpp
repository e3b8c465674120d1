// The topics of a node: markers, state, status, the transform of the camera, and optionally /clock.
//
// Messages without subscribers are not built. A state has the same stamp on every topic.
#pragma once

#include "ros/messages/run_messages.hpp"

#include <ros/node_handle.h>

#include <cstdint>
#include <optional>
#include <string>

namespace spring_pendulum {

/// How to show a state.
struct Showing {
  bool paused = false;  ///< whether the user has paused the run
  std::string pace;     ///< speed of the run, for the text
  bool due = true;      ///< false: publish nothing but a changed status
};

class Publisher {
 public:
  Publisher(ros::NodeHandle& node, const Run& run, const NodeOptions& options);

  /// Whether a topic that shows states between the frames has subscribers.
  bool isWatched() const;

  /// Serves callbacks until `wait_for_subscribers` is reached, or `wait_timeout` has passed.
  void waitForSubscribers(const NodeOptions& options);

  /// Keeps the camera where it is, see MarkerBuilder.
  void freezeCamera(bool freeze) { build_.freezeCamera(freeze); }

  /// Publishes the state on all topics with subscribers, and the status if it has changed.   /// \returns the header of the messages; nothing if the state was not due
  std::optional<std_msgs::Header> publish(const Run& run, const Showing& showing);

  /// Removes the markers from rviz, which keeps them when the node has ended.
  void clear();

  std::int64_t markersBuilt() const { return markers_built_; }
  std::int64_t statesBuilt() const { return states_built_; }

 private:
  std::uint32_t subscribers() const;
  void publishMarkers(const Run& run, const std_msgs::Header& header, const std::string& pace);

  bool publishes_clock_;
  RunMessages build_;
  std::int64_t markers_built_ = 0;
  std::int64_t states_built_ = 0;
  ros::Publisher markers_;
  ros::Publisher state_;
  ros::Publisher status_;
  ros::Publisher clock_;
  ros::Publisher tf_static_;
};

}  // namespace spring_pendulum
