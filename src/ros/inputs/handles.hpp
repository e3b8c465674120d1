// Handles in rviz: interactive markers with which the mouse drags particles.
#pragma once

#include "ros/inputs/driver.hpp"
#include "ros/inputs/frames.hpp"
#include "ros/messages/stamps.hpp"
#include "ros/parameters/node_options.hpp"

#include <ros/node_handle.h>

#include <cstdint>
#include <interactive_markers/interactive_marker_server.h>
#include <map>
#include <optional>
#include <vector>

namespace spring_pendulum {

/// Handles on all particles of a short chain and on twenty of a long one. A dragged particle follows the
/// mouse and is released when the button is, or when the mouse is silent for a second.
class Handles {
 public:
  Handles(ros::NodeHandle& node, const Run& run, const NodeOptions& options, const Driver& driver,
          Frames& frames, RequestHandler take);

  /// Releases particles whose mouse is silent. Must be called before every state.
  void releaseSilent();
  /// Whether the mouse drags a particle.
  bool isDragging() const { return !drags_.empty(); }
  void show();  ///< moves the handles to the particles; costs nothing without rviz
  /// Lets go of all particles.
  void reset() { drags_.clear(); }

 private:
  using Feedback = visualization_msgs::InteractiveMarkerFeedbackConstPtr;
  struct Drag {
    ros::SteadyTime heard;  ///< last feedback
    bool was_held;          ///< whether the particle was held before
  };

  geometry_msgs::Pose poseOf(std::ptrdiff_t particle) const;
  void ask(const Request& request);  ///< asks the node, and logs a refusal
  void onFeedback(std::ptrdiff_t particle, const Feedback& feedback);
  /// Returns where the mouse is in the plane; nothing if it cannot be followed.
  std::optional<Target> targetOf(std::ptrdiff_t particle, const Feedback& feedback);
  void release(std::ptrdiff_t particle);

  const Run& run_;
  const Driver& driver_;
  Frames& frames_;
  RequestHandler take_;
  double farthest_;  ///< m, largest believable distance of the mouse from the particle
  interactive_markers::InteractiveMarkerServer server_;
  std::vector<std::ptrdiff_t> particles_;
  std::map<std::ptrdiff_t, Drag> drags_;  ///< by dragged particle
  Throttle warnings_;
  ros::Publisher updates_;  ///< counts the subscribers of the server
};

}  // namespace spring_pendulum
