#include "ros/markers/picture.hpp"

#include <cmath>

namespace spring_pendulum {

// In sizes of the picture:
constexpr double kDepth = 0.02;  ///< behind the plane of the motion
constexpr double kWidth = 0.0015;
constexpr double kReach = 1.5;        ///< beyond the scene to the left and right, for wide windows
constexpr double kMostLines = 100.0;  ///< in each direction; measured: 86

void drawGrid(const Picture& picture, Marker& grid) {
  const double size = picture.view.size(), distance = picture.view.gridDistance();
  setScale(grid, kWidth * size);
  grid.color = colorOf(0x788291, 0.25F);
  grid.points.clear();
  if (picture.chainsInFront() > 0.0) return;
  const Eigen::Vector2d reach(kReach * size, 0.5 * size);
  const Eigen::Vector2d end = picture.view.box.max() + reach;
  const Eigen::Vector2d begin =
      distance * ((picture.view.box.min() - reach) / distance).array().floor();
  for (const int axis : {0, 1}) {
    const double lines = (end[axis] - begin[axis]) / distance;  // counted: x + distance may be x
    for (int line = 0; line <= (lines < kMostLines ? static_cast<int>(lines) : 0); ++line)
      for (Eigen::Vector2d point : {begin, end}) {
        point[axis] = begin[axis] + line * distance;
        grid.points.push_back(pointAt(point.x(), kDepth * size, point.y()));
      }
  }
}

}  // namespace spring_pendulum
