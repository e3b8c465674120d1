// The visible part of the plane of motion, and the camera that shows it.
#pragma once

#include <spring_pendulum/simulation/run.hpp>

#include <Eigen/Geometry>

namespace spring_pendulum {

/// A frame around the start and what hangs from P_1 at rest. It widens in steps, then follows the chain.
struct SceneView {
  /// \param hangs whether only P_1 is held
  SceneView(const Run& run, bool hangs);

  /// Widens or moves the frame if the chain has left it, unless it diverges. Returns whether the frame changed.
  bool widenFor(const State& state);

  double size() const;  ///< of the picture, m: the unit of line widths and text heights
  double textHeight() const { return 0.04 * size(); }
  double lineDistance() const { return 1.35 * textHeight(); }
  double gridDistance() const;  ///< of the grid lines, m: 1, 2 or 5 times a power of ten
  /// Height of the axis of the camera, m.
  double cameraHeight() const { return box.center().y() + 0.5 * kTextLines * lineDistance(); }
  /// Distance of the camera from the plane, m, for the field of view of rviz, 45 degrees.
  double cameraDistance() const;

  static constexpr int kTextLines = 3;  ///< above the scene

  Eigen::AlignedBox2d box;  ///< the visible rectangle of the plane, m, without the text above it
  double start_size = 1.0;  ///< of the first picture, m
};

}  // namespace spring_pendulum
