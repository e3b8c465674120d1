// The chain as rviz markers: six, whatever its length, and one for the reference on request.
//
// Springs are one LINE_LIST coloured by strain, particles one SPHERE_LIST coloured by mass; rviz
// draws thousands of them in one batch, where a marker a particle would stop it. Every marker has a
// fixed namespace and id, so each message replaces the one before. A long chain is thinned for
// display, and the text says so.
#pragma once

#include "ros/node_options.hpp"
#include "ros/pendulum_run.hpp"
#include "ros/scene_view.hpp"
#include "ros/shown_state.hpp"

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
  MarkerBuilder(const PendulumRun& run, const NodeOptions& options);

  /// Adds the tip to the trail; a time before the last one starts a new trail.
  void trackTip(const PendulumRun& run);

  /// A state that can't be drawn, of a motion that diverged, leaves the chain as it was last drawn
  /// and changes its colour.
  /// \param pace how fast the run goes, for the text: "1.00 x real time"
  /// \return valid until the next call
  const visualization_msgs::MarkerArray& build(const PendulumRun& run, const ShownState& shown,
                                               const std_msgs::Header& header,
                                               const std::string& pace);

  /// Where the camera stands that shows the whole scene: x forward, z up. Only after `build`.
  geometry_msgs::TransformStamped camera(const std_msgs::Header& header) const;
  /// How often `build` has moved the camera.
  int cameraChanges() const { return camera_changes_; }

 private:
  struct TrailPoint {
    double time;
    geometry_msgs::Point point;
  };

  int textLines() const;
  void frame(const PendulumRun& run, const State& state);
  void placeText();
  void drawGrid();
  geometry_msgs::Point pointOf(const State& state, Eigen::Index i) const;
  void place(const PendulumRun& run, const State& state);
  void paint(const PendulumRun& run);
  void drawReference(const PendulumRun& run);
  void drawTrail(const ShownState& shown);
  void label(const PendulumRun& run, double time, const std::string& pace);
  std_msgs::ColorRGBA springColor(const PendulumRun& run, std::size_t spring) const;

  NodeOptions options_;
  std::vector<Eigen::Index> drawn_;               ///< the particles that are drawn
  std::vector<std_msgs::ColorRGBA> mass_colors_;  ///< of the particles that are drawn
  std::vector<double> strains_;                   ///< of the springs as last drawn
  double full_color_strain_ = 1.0;
  bool placed_ = false;  ///< whether the chain has been drawn
  std::deque<TrailPoint> trail_;
  std::optional<SceneView> view_;  ///< made when the first state is drawn
  int camera_changes_ = 0;
  visualization_msgs::MarkerArray markers_;
};

}  // namespace spring_pendulum
