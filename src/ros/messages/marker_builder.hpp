// The chain as rviz markers: seven for any length.
//
// Springs are one LINE_LIST coloured by strain, particles one SPHERE_LIST coloured by mass. rviz
// draws such a list in one batch; with one marker per particle it is unusable. Every marker has a
// fixed namespace and id, so each message replaces the previous one, also that of another run; what is
// not drawn is deleted. A long chain is thinned for
// display, which the text mentions.
#pragma once

#include "ros/messages/scene_view.hpp"
#include "ros/parameters/node_options.hpp"
#include <spring_pendulum/simulation/run.hpp>

#include <geometry_msgs/TransformStamped.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace spring_pendulum {

class MarkerBuilder {
 public:
  MarkerBuilder(const Run& run, const NodeOptions& options);

  /// Adds the tip to the trail; a time before the last one starts a new trail.
  void trackTip(const Run& run);

  /// If the state of a diverged motion can't be drawn, the chain keeps its last shape and changes
  /// its colour.
  /// \param pace speed of the run for the text: "1.00 x real time"
  /// \returns a reference that is valid until the next call
  const visualization_msgs::MarkerArray& build(const Run& run, const std_msgs::Header& header,
                                               const std::string& pace);

  /// Keeps the camera where it is, for example while the mouse drags a particle.
  void freezeCamera(bool freeze) { camera_frozen_ = freeze; }

  /// Pose of a camera that shows the whole scene: x forward, z up. Valid after `build`.
  geometry_msgs::TransformStamped camera(const std_msgs::Header& header) const;
  /// Number of camera moves by `build`; always 0 for a chain that is not in the first row of text.
  int cameraChanges() const { return camera_changes_; }

 private:
  struct TrailPoint {
    double time;
    geometry_msgs::Point point;
  };

  bool isFirstRow() const { return options_.text_row == 0; }
  int textLines() const;
  /// Makes the view contain the state, and sets the sizes that depend on it.
  void fitView(const Run& run, const State& state);
  void placeText();
  void placeRow(visualization_msgs::Marker& text) const;
  void drawGrid();
  geometry_msgs::Point pointOf(const State& state, Eigen::Index i) const;
  void place(const Run& run, const State& state);
  void breakSprings();
  void paint(const Run& run);
  void drawReference(const Run& run);
  void drawTrail();
  void label(const Run& run, const std::string& pace);
  std_msgs::ColorRGBA springColor(const Run& run, std::size_t spring) const;

  NodeOptions options_;
  std::vector<Eigen::Index> drawn_;               ///< indices of the drawn particles
  std::vector<std_msgs::ColorRGBA> mass_colors_;  ///< of the drawn particles
  std::vector<double> strains_;                   ///< of the springs in the last drawn state
  double full_color_strain_ = 1.0;
  bool placed_ = false;  ///< whether the chain has been drawn
  std::deque<TrailPoint> trail_;
  std::optional<SceneView> view_;  ///< set when the first state is drawn
  int camera_changes_ = 0;
  bool camera_frozen_ = false;
  visualization_msgs::MarkerArray markers_;
};

}  // namespace spring_pendulum
