// Handles in rviz: interactive markers with which particles are grabbed, and their context menu.
#pragma once

#include "ros/inputs/answer.hpp"
#include "ros/inputs/frames.hpp"
#include "ros/inputs/holders.hpp"
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

/// What the menu asks of the program.
struct MenuActions {
  std::function<void()> toggle_pause;
  std::function<void()> step;
  std::function<void()> reset;
  std::function<void()> save_state;
  std::function<void()> show;  ///< shows the state again soon
};

/// Handles on all particles of a short chain and on twenty of a long one. A dragged particle follows the
/// hand and is released when the button is, or when the hand is silent for a second.
class Handles {
 public:
  Handles(ros::NodeHandle& node, const Run& run, const NodeOptions& options, Holders& holders,
          Frames& frames, MenuActions actions);

  /// Releases hands that are silent. Must be called before every state.
  void watch();
  /// Whether the mouse drags a particle.
  bool isGrabbed() const { return !hands_.empty(); }
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

  struct Hand {
    ros::SteadyTime heard;  ///< last feedback
    bool was_held;          ///< whether the particle was held before
  };

  void insert(std::ptrdiff_t particle, double size);
  geometry_msgs::Pose poseOf(std::ptrdiff_t particle) const;
  void makeMenu();
  void addEntry(const std::string& title, std::function<void(std::ptrdiff_t)> action);
  void addSwitch(const std::string& title, double Scenario::*constant, double on);
  void addMethods();
  /// Checks the entries of what is in effect, unless a hand would lose its particle by that.
  void checkMenu();
  void onFeedback(std::ptrdiff_t particle, const Feedback& feedback);
  /// Returns a position in the plane; nothing if it cannot be used.
  std::optional<PlaneVector<double>> planePosition(const Feedback& feedback);

  const Run& run_;
  Holders& holders_;
  Frames& frames_;
  MenuActions actions_;
  std::string frame_id_;
  double y_;
  double farthest_;  ///< m from the particle, of a believable hand
  interactive_markers::InteractiveMarkerServer server_;
  interactive_markers::MenuHandler menu_;
  std::map<Entry, std::function<bool()>> checks_;
  std::map<Entry, bool> checked_;
  std::vector<std::ptrdiff_t> particles_;
  std::map<std::ptrdiff_t, Hand> hands_;  ///< by dragged particle
  Throttle warnings_;
  ros::Publisher updates_;  ///< counts the subscribers of the server
};

}  // namespace spring_pendulum
