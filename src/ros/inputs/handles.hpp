// Handles in rviz: interactive markers with which particles are grabbed, and their context menu.
#pragma once

#include "ros/inputs/driver.hpp"
#include "ros/inputs/frames.hpp"
#include "ros/messages/throttle.hpp"
#include "ros/parameters/node_options.hpp"

#include <ros/node_handle.h>

#include <cstdint>
#include <functional>
#include <interactive_markers/interactive_marker_server.h>
#include <interactive_markers/menu_handler.h>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace spring_pendulum {

/// Handles on all particles of a short chain and on twenty of a long one. A dragged particle follows the
/// hand and is released when the button is, or when the hand is silent for a second.
class Handles {
 public:
  Handles(ros::NodeHandle& node, const Run& run, const NodeOptions& options, const Driver& driver,
          Frames& frames, RequestHandler take);

  /// Releases hands that are silent. Must be called before every state.
  void releaseSilent();
  /// Whether the mouse drags a particle.
  bool isGrabbed() const { return !drags_.empty(); }
  /// Moves the handles to the particles. Costs nothing without rviz.
  void show();
  /// Lets go of all particles.
  void reset() { drags_.clear(); }

 private:
  using Feedback = visualization_msgs::InteractiveMarkerFeedbackConstPtr;
  struct Drag {
    ros::SteadyTime heard;  ///< last feedback
    bool was_held;          ///< whether the particle was held before
  };
  using Drags = std::map<std::ptrdiff_t, Drag>;

  void insert(std::ptrdiff_t particle, double size);
  geometry_msgs::Pose poseOf(std::ptrdiff_t particle) const;
  void makeMenu();
  void addSwitch(const std::string& name, double (*constant)(const Constants&));
  /// Asks the node, and logs a refusal.
  void ask(const Request& request);
  /// Returns an entry of the menu that asks for the request of a particle.
  interactive_markers::MenuHandler::FeedbackCallback asks(
      std::function<Request(std::ptrdiff_t)> request);
  void onFeedback(std::ptrdiff_t particle, const Feedback& feedback);
  /// Returns where the mouse is in the plane; nothing if it cannot be followed.
  std::optional<Target> targetOf(std::ptrdiff_t particle, const Feedback& feedback);
  Drags::iterator release(Drags::iterator drag);

  const Run& run_;
  const Driver& driver_;
  Frames& frames_;
  RequestHandler take_;
  std::string frame_id_;
  double farthest_;  ///< m from the particle, of a believable hand
  interactive_markers::InteractiveMarkerServer server_;
  interactive_markers::MenuHandler menu_;
  std::vector<std::ptrdiff_t> particles_;
  Drags drags_;  ///< by dragged particle
  Throttle warnings_;
  ros::Publisher updates_;  ///< counts the subscribers of the server
};

}  // namespace spring_pendulum
