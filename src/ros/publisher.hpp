// The topics of a node: markers, state, status, the camera's transform, and /clock on request.
//
// What nobody subscribes to is not built. One stamp a state, the same on every topic.
#pragma once

#include "ros/marker_builder.hpp"
#include "ros/master_registration.hpp"
#include "ros/shown_state.hpp"
#include "ros/stamps.hpp"
#include "ros/state_builder.hpp"
#include <spring_pendulum/PendulumStatus.h>

#include <ros/node_handle.h>

#include <cstdint>
#include <string>

namespace spring_pendulum {

/// PendulumStatus code and text for a run.
/// \param paused the user has stopped it
PendulumStatus statusOf(const PendulumRun& run, bool paused);

class Publisher {
 public:
  Publisher(ros::NodeHandle& node, const PendulumRun& run, const NodeOptions& options,
            MasterRegistration& registration);

  /// Whether anybody wants to see states between the frames.
  bool isWatched() const;

  /// Serves callbacks until `wait_for_subscribers` is reached, or `wait_timeout` has passed.
  void waitForSubscribers(const NodeOptions& options);

  /// Sends the state to all who want it, and the status if it has changed.
  /// \param pace  how fast the run goes, for the text
  /// \param share the markers show this share of the way from the state before to that of the run
  void publish(const PendulumRun& run, bool paused, const std::string& pace, double share);
  /// Sends only the markers again, of a state between the last two.
  void publishBetween(const PendulumRun& run, const std::string& pace, double share);

  std::int64_t markersBuilt() const { return markers_built_; }
  std::int64_t statesBuilt() const { return states_built_; }

 private:
  std::uint32_t subscribers() const;
  void publishMarkers(const PendulumRun& run, const std_msgs::Header& header,
                      const std::string& pace, double share);
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
