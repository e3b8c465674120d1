// The topics of a node: markers, state, status, the transform of the camera, and optionally /clock.
//
// Messages without subscribers are not built. A state has the same stamp on every topic.
#pragma once

#include "ros/messages/marker_builder.hpp"
#include "ros/messages/shown_state.hpp"
#include "ros/messages/stamps.hpp"
#include "ros/messages/state_builder.hpp"
#include <spring_pendulum/PendulumStatus.h>

#include <ros/node_handle.h>

#include <cstdint>
#include <string>

namespace spring_pendulum {

/// PendulumStatus code and text for a run.
/// \param paused whether the user has paused the run
PendulumStatus statusOf(const Run& run, bool paused);

/// How to show a state.
struct Showing {
  bool paused = false;  ///< whether the user has paused the run
  std::string pace;     ///< speed of the run, for the text
  double share = 1.0;  ///< slow motion: position between the previous state (0) and the current one
  bool due = true;     ///< false: publish nothing but a changed status
};

class Publisher {
 public:
  Publisher(ros::NodeHandle& node, const Run& run, const NodeOptions& options);

  /// Whether a topic that shows states between the frames has subscribers.
  bool isWatched() const;

  /// Serves callbacks until `wait_for_subscribers` is reached, or `wait_timeout` has passed.
  void waitForSubscribers(const NodeOptions& options);

  /// Publishes the state on all topics with subscribers, and the status if it has changed. In slow
  /// motion, the markers are left to `publishBetween`.
  void publish(const Run& run, const Showing& showing);
  /// Publishes only the markers, for a state between the last two.
  void publishBetween(const Run& run, const Showing& showing);

  /// Removes the markers from rviz, which keeps them when the node has ended.
  void clear();

  std::int64_t markersBuilt() const { return markers_built_; }
  std::int64_t statesBuilt() const { return states_built_; }

 private:
  std::uint32_t subscribers() const;
  bool isNew(const PendulumStatus& status) const;
  void publishMarkers(const Run& run, const std_msgs::Header& header, const std::string& pace);
  void publishStatus(PendulumStatus status, const ros::Time& stamp);

  std::string frame_id_;
  std::string camera_frame_;
  bool publishes_clock_;
  Stamps stamps_;
  MarkerBuilder marker_builder_;
  ShownState shown_;
  StateBuilder state_builder_;
  PendulumStatus status_;
  bool status_sent_ = false;
  int camera_changes_sent_ = 0;
  std::int64_t markers_built_ = 0;
  std::int64_t states_built_ = 0;
  ros::Publisher markers_;
  ros::Publisher state_;
  ros::Publisher status_topic_;
  ros::Publisher clock_;
  ros::Publisher tf_static_;
};

}  // namespace spring_pendulum
