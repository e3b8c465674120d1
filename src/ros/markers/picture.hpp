// What the markers draw from. The chain, the text and the grid are a file each.
// rviz draws a list of points in one batch; with one marker per particle it is unusable.
#pragma once

#include "ros/markers/scene_view.hpp"
#include "ros/parameters/node_options.hpp"
#include <spring_pendulum/simulation/run.hpp>

#include <std_msgs/ColorRGBA.h>
#include <visualization_msgs/Marker.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace spring_pendulum {

using visualization_msgs::Marker;

/// A state of a run with its view. Sizes are relative to the view, so all scenes look alike.
struct Picture {
  const Run& run;
  const NodeOptions& options;
  const SceneView& view;
  const std::vector<Eigen::Index>& drawn;  ///< indices of the drawn particles

  /// Whether the state can be drawn; if not, the chain keeps its last shape.
  bool isDrawable() const { return run.isFinite() && run.isShown() && drawn.size() > 1; }

  /// Diameter of a particle, m.
  double diameter() const {
    return view.size() * std::clamp(0.35 / static_cast<double>(drawn.size()), 0.009, 0.036);
  }
  /// Width of a spring, m.
  double width() const { return std::max(0.35 * diameter(), 0.0035 * view.size()); }
  /// y of springs behind the particles, and of the anchor in front of them, m: rviz draws a
  /// particle as a disc that faces the camera, so it is tilted by up to 28 degrees.
  double depth() const { return 0.3 * diameter(); }
  /// Number of chains in front of this one.
  double chainsInFront() const {
    return static_cast<double>(std::max<std::int64_t>(options.text_row - 1, 0));
  }
};

inline geometry_msgs::Point pointAt(double x, double y, double z) {
  geometry_msgs::Point point;
  point.x = x;
  point.y = y;
  point.z = z;
  return point;
}

/// Returns the indices of at most `most` particles, with the first and the last one.
std::vector<Eigen::Index> evenlyChosen(Eigen::Index particles, Eigen::Index most);

/// Returns the position of particle i, counted from 0.
inline geometry_msgs::Point pointOf(const State& state, Eigen::Index i, double y = 0.0) {
  return pointAt(state.x()[i], y, state.y()[i]);
}

/// Returns the strain of a spring, length/rest length - 1, or its length in m if the rest length is 0.
inline double strainOf(double length, double rest_length) {
  return rest_length > 0.0 ? length / rest_length - 1.0 : length;
}

inline void setScale(Marker& marker, double size) {
  marker.scale.x = marker.scale.y = marker.scale.z = size;
}

/// \param rgb 0xrrggbb
std_msgs::ColorRGBA colorOf(std::uint32_t rgb, float opacity = 1.0F);
/// \param text "#rrggbb"
std_msgs::ColorRGBA colorOf(const std::string& text);
/// Returns the first color for a share of 0 and below, the second one for 1 and above.
std_msgs::ColorRGBA mix(const std_msgs::ColorRGBA& from, const std_msgs::ColorRGBA& to,
                        double share);

constexpr std::uint32_t kHeldColor = 0x9aa4b2;      ///< of held particles
constexpr std::uint32_t kDoubtColor = 0xffb000;     ///< of springs if the verdict is bad
constexpr std::uint32_t kDivergedColor = 0xff2fd0;  ///< of the whole chain

/// From blue for shortened springs over white for springs without force to red for stretched and dark
/// red for overstretched ones; amber if the verdict is bad, magenta if the motion has diverged.
void drawSprings(const Picture& picture, Marker& springs);
/// From light ones in pale yellow to heavy ones in violet, on a logarithmic scale; held ones are grey.
void drawParticles(const Picture& picture, Marker& particles);
void drawAnchor(const Picture& picture, Marker& anchor);  ///< a square in front of P_1
/// Method, time, errors and verdict above the scene.
void drawText(const Picture& picture, Marker& text);
void drawGrid(const Picture& picture, Marker& grid);

}  // namespace spring_pendulum
