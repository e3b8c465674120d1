// The messages about a run, for the topics of a node and for bags.
#pragma once

#include "ros/markers/picture.hpp"
#include "ros/messages/stamps.hpp"
#include "ros/parameters/node_options.hpp"
#include <spring_pendulum/PendulumState.h>
#include <spring_pendulum/PendulumStatus.h>
#include <spring_pendulum/simulation/run.hpp>

#include <visualization_msgs/MarkerArray.h>

#include <optional>
#include <string>
#include <tf2_msgs/TFMessage.h>
#include <vector>

namespace spring_pendulum {

/// Sets all fields of the message of a state.
void setState(PendulumState& message, const Run& run, const std_msgs::Header& header);

/// How to show a state, and to whom.
struct Showing {
  bool paused = false;        ///< whether the user has paused the run
  bool due = true;            ///< false: nothing but a changed status
  bool same_camera = false;   ///< it must not move, for example under the mouse
  bool wants_markers = true;  ///< messages that nobody wants are not built
  bool wants_state = true;
};

/// The messages about one state, all with this header. Valid until the next ones are built.
struct StateMessages {
  std_msgs::Header header;
  /// Pose of a camera that shows the whole scene, x forward, z up. Only the first of several chains has one.
  std::optional<tf2_msgs::TFMessage> camera;                 ///< if it has moved
  const visualization_msgs::MarkerArray* markers = nullptr;  ///< null: not wanted
  const PendulumState* state = nullptr;                      ///< null: not wanted
  std::optional<PendulumStatus> status;                      ///< if it has changed
};

/// Builds the messages about a run. Markers have fixed namespaces and ids, so each message replaces the
/// last one, also of another run; what is not drawn is deleted. A long chain is thinned, as the text says.
class RunMessages {
 public:
  /// \param simulated stamp with simulated time instead of ROS time
  /// \throws InputError if the run ends after the last simulated stamp
  RunMessages(const Run& run, const NodeOptions& options, bool simulated);

  /// Returns the header of the next messages, with a new stamp.
  std_msgs::Header header(double simulated_time);

  /// Returns the messages about the current state; nothing if it is not due and the status is the same.
  std::optional<StateMessages> build(const Run& run, const Showing& showing);

 private:
  void draw(const Run& run, const std_msgs::Header& header, bool same_camera);
  tf2_msgs::TFMessage camera(const std_msgs::Header& header) const;

  NodeOptions options_;
  Stamps stamps_;
  std::vector<Eigen::Index> drawn_;  ///< indices of the drawn particles
  SceneView view_;
  bool camera_moved_;
  visualization_msgs::MarkerArray markers_;
  PendulumState state_;  ///< kept, so that its arrays are allocated once
  std::string last_status_;
};

}  // namespace spring_pendulum
