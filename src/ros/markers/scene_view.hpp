// The visible part of the plane of motion, and the camera that shows it.
#pragma once

#include <spring_pendulum/simulation/run.hpp>

#include <Eigen/Geometry>

namespace spring_pendulum {

/// A frame around the start and, for a chain that hangs from P_1, its length at rest. When the chain
/// leaves the frame, the frame widens in steps.
class SceneView {
 public:
  /// \param hangs whether only P_1 is held
  SceneView(const Run& run, bool hangs);

  /// Widens the frame if the chain has left it.
  /// \returns whether the frame changed
  bool widenFor(const State& state);

  /// The visible rectangle of the plane, m, without the text above it.
  const Eigen::AlignedBox2d& box() const { return box_; }
  /// Size of the picture in m: the unit of line widths and text heights.
  double size() const;
  double textHeight() const;
  /// Distance of the lines of text, m.
  double lineDistance() const;
  /// Distance of the grid lines, m: 1, 2 or 5 times a power of ten.
  double gridDistance() const;

  /// Height of the axis of the camera, m.
  double cameraHeight() const;
  /// Distance of the camera from the plane, m, for the field of view of rviz, 45 degrees.
  double cameraDistance() const;

  static constexpr int kTextLines = 3;  ///< above the scene

 private:
  Eigen::AlignedBox2d largest_;  ///< limit of the frame, which a diverging motion leaves
  Eigen::AlignedBox2d box_;
};

}  // namespace spring_pendulum
