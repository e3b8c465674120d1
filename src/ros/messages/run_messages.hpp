// The messages about a run, for the topics of a node and for bags.
#pragma once

#include "ros/messages/marker_builder.hpp"
#include "ros/messages/stamps.hpp"
#include "ros/messages/state_builder.hpp"
#include "ros/parameters/node_options.hpp"
#include <spring_pendulum/PendulumStatus.h>
#include <spring_pendulum/simulation/run.hpp>

#include <optional>
#include <string>
#include <tf2_msgs/TFMessage.h>

namespace spring_pendulum {

/// A state has the same header in every message. References are valid until the next call.
class RunMessages {
 public:
  /// \param simulated stamp with simulated time instead of ROS time
  /// \throws InputError if the run ends after the last simulated stamp
  RunMessages(const Run& run, const NodeOptions& options, bool simulated);

  /// Returns the header of the next messages, with a new stamp.
  std_msgs::Header header(double simulated_time);

  /// Adds the tip to the trail, also of a state without markers.
  void trackTip(const Run& run) { markers_.trackTip(run); }
  void freezeCamera(bool freeze) { markers_.freezeCamera(freeze); }
  const visualization_msgs::MarkerArray& markers(const Run& run, const std_msgs::Header& header,
                                                 const std::string& pace = "") {
    return markers_.build(run, header, pace);
  }
  /// Returns the transform of the camera if `markers` has moved it since the last call.
  std::optional<tf2_msgs::TFMessage> newCamera(const std_msgs::Header& header);
  const PendulumState& state(const Run& run, const std_msgs::Header& header) {
    return state_.build(run, header);
  }
  /// Returns the status, without a header, if it differs from the last one.
  /// \param paused whether the user has paused the run
  std::optional<PendulumStatus> newStatus(const Run& run, bool paused = false);

 private:
  std::string frame_id_;
  bool has_camera_;
  Stamps stamps_;
  MarkerBuilder markers_;
  StateBuilder state_;
  int camera_changes_ = 0;
  std::string last_status_;
};

}  // namespace spring_pendulum
