// The topics of a node: markers, state, status, the transform of the camera, and optionally /clock.
#pragma once

#include "ros/messages/run_messages.hpp"

#include <ros/node_handle.h>

#include <cstdint>
#include <optional>
#include <string>

namespace spring_pendulum {

class Publisher : private Outlet {
 public:
  Publisher(ros::NodeHandle& node, const Run& run, const NodeOptions& options);

  /// Whether a topic that shows states between the frames has subscribers.
  bool isWatched() const { return publishes_clock_ || wantsMarkers() || wantsState(); }
  /// Serves callbacks until `wait_for_subscribers` is reached, or `wait_timeout` has passed.
  void waitForSubscribers(const NodeOptions& options);
  void freezeCamera(bool freeze) { messages_.freezeCamera(freeze); }
  std::optional<std_msgs::Header> publish(const Run& run, const Showing& showing) {
    return messages_.send(run, showing, *this);
  }
  /// Removes the markers from rviz, which keeps them when the node has ended.
  void clear();
  /// Returns for the closing line: "12 marker and 30 state messages built".
  std::string numbers() const;

 private:
  bool wantsMarkers() const override { return markers_.getNumSubscribers() > 0; }
  bool wantsState() const override { return state_.getNumSubscribers() > 0; }
  void start(const std_msgs::Header& header) override;
  void put(const tf2_msgs::TFMessage& camera) override { tf_static_.publish(camera); }
  void put(const visualization_msgs::MarkerArray& markers) override;
  void put(const PendulumState& state) override;
  void put(const PendulumStatus& status) override { status_.publish(status); }

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
