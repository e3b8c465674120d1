// The chain as rviz markers: seven for any length.
#pragma once

#include "ros/markers/picture.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <optional>
#include <string>
#include <vector>

namespace spring_pendulum {

/// Returns the indices of at most `most` particles, with the first and the last one.
std::vector<Eigen::Index> evenlyChosen(Eigen::Index particles, Eigen::Index most);

/// Every marker has a fixed namespace and id, so each message replaces the previous one, also that of
/// another run; what is not drawn is deleted. A long chain is thinned, which the text mentions.
class Markers {
 public:
  Markers(const Run& run, const NodeOptions& options);

  /// Adds the tip to the trail.
  void trackTip(const Run& run) { trail_.track(run, options_.trail); }

  /// \param pace speed of the run for the text: "1.00 x real time"
  /// \returns a reference that is valid until the next call
  const visualization_msgs::MarkerArray& draw(const Run& run, const std_msgs::Header& header,
                                              const std::string& pace);

  /// Keeps the camera where it is, for example while the mouse drags a particle.
  void freezeCamera(bool freeze) { camera_frozen_ = freeze; }

  /// Returns the pose of a camera that shows the whole scene, x forward, z up, if `draw` has moved it
  /// since the last call. Only the first of several chains has one.
  std::optional<geometry_msgs::TransformStamped> newCamera(const std_msgs::Header& header);

 private:
  NodeOptions options_;
  std::vector<Eigen::Index> drawn_;  ///< indices of the drawn particles
  SceneView view_;
  Trail trail_;
  bool camera_moved_ = true;
  bool camera_frozen_ = false;
  visualization_msgs::MarkerArray markers_;
};

}  // namespace spring_pendulum
