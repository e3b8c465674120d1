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
  void reset();

  static constexpr std::size_t kMost = 20;
  /// Returns the particles with handles, evenly chosen, with the first and the last one.
  static std::vector<std::ptrdiff_t> chosen(std::ptrdiff_t particles);

 private:
  using Feedback = visualization_msgs::InteractiveMarkerFeedbackConstPtr;
  using Entry = interactive_markers::MenuHandler::EntryHandle;

  struct Drag {
    ros::SteadyTime heard;  ///< last feedback
    bool was_held;          ///< whether the particle was held before
  };

  void insert(std::ptrdiff_t particle, double size);
  geometry_msgs::Pose poseOf(std::ptrdiff_t particle) const;
  void makeMenu();
  /// Asks the node, and logs a refusal.
  void ask(const Request& request);
  /// \param request makes the request for a particle
  void addEntry(const std::string& title, std::function<Request(std::ptrdiff_t)> request);
  void addSwitch(const std::string& title, const std::string& name, double Scenario::*constant,
                 double on);
  /// Checks the entries of what is in effect, unless a hand would lose its particle by that.
  void checkMenu();
  void onFeedback(std::ptrdiff_t particle, const Feedback& feedback);
  /// Returns a position in the plane; nothing if it cannot be used.
  std::optional<PlaneVector<double>> planePosition(const Feedback& feedback);

  const Run& run_;
  const Driver& driver_;
  Frames& frames_;
  RequestHandler take_;
  std::string frame_id_;
  double y_;
  double farthest_;  ///< m from the particle, of a believable hand
  interactive_markers::InteractiveMarkerServer server_;
  interactive_markers::MenuHandler menu_;
  std::map<Entry, std::function<bool()>> checks_;
  std::map<Entry, bool> checked_;
  std::vector<std::ptrdiff_t> particles_;
  std::map<std::ptrdiff_t, Drag> drags_;  ///< by dragged particle
  Throttle warnings_;
  ros::Publisher updates_;  ///< counts the subscribers of the server
};

}  // namespace spring_pendulum
