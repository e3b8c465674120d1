// The visible part of the plane of motion, and the camera that shows it.
#pragma once

#include <spring_pendulum/simulation/run.hpp>

namespace spring_pendulum {

/// A rectangle in the plane of motion, m.
struct Box {
  double left = 0.0;
  double right = 0.0;
  double bottom = 0.0;
  double top = 0.0;

  void include(const Box& other);
  double width() const { return right - left; }
  double height() const { return top - bottom; }
  double centerX() const { return 0.5 * (left + right); }
};

/// A frame around the start and, for a chain that hangs from P_1, its length at rest. When the chain
/// leaves the frame, the frame widens in steps.
class SceneView {
 public:
  /// \param hangs      whether only P_1 is held
  /// \param text_lines lines of text above the scene
  SceneView(const Run& run, bool hangs, int text_lines);

  /// Widens the frame if the chain has left it.
  /// \returns whether the frame changed
  bool widenFor(const State& state);

  /// The visible rectangle of the plane, without the text above it.
  const Box& box() const { return box_; }
  /// Size of the picture in m: the unit of line widths and text heights.
  double size() const;
  double textHeight() const;
  /// Half the height of the picture in the plane, with the text, m.
  double halfHeight() const;
  /// Distance of the lines of text, m.
  double lineDistance() const;
  /// Distance of the grid lines, m: 1, 2 or 5 times a power of ten.
  double gridDistance() const;

  /// Height of the axis of the camera, m.
  double cameraHeight() const;
  /// Distance of the camera from the plane, m, for the field of view of rviz, 45 degrees.
  double cameraDistance() const;

 private:
  int text_lines_;
  Box largest_;  ///< limit of the frame, which a diverging motion leaves
  Box box_;
};

}  // namespace spring_pendulum
