#include "ros/markers/picture.hpp"

#include <cmath>

namespace spring_pendulum {
namespace {

// In sizes of the picture:
constexpr double kDepth = 0.02;  ///< behind the plane of the motion
constexpr double kWidth = 0.0015;
constexpr double kReach = 1.5;        ///< beyond the scene to the left and right, for wide windows
constexpr double kMostLines = 100.0;  ///< in each direction; measured: 86

}  // namespace

void drawGrid(const Picture& picture, Marker& grid) {
  const double size = picture.view.size(), distance = picture.view.gridDistance();
  setScale(grid, kWidth * size);
  grid.color = colorOf(kGridColor, 0.25F);
  grid.points.clear();
  if (picture.chainsInFront() > 0.0) return;
  const Eigen::Vector2d reach(kReach * size, 0.5 * size);
  const Eigen::Vector2d end = picture.view.box.max() + reach;
  const Eigen::Vector2d begin =
      distance * ((picture.view.box.min() - reach) / distance).array().floor();
  // Counted in integers: far from the origin, x + distance rounds to x.
  const auto count = [distance](double length) {
    return length / distance < kMostLines ? static_cast<int>(length / distance) : 0;
  };
  const auto add = [&](double x, double z) { grid.points.push_back(pointAt(x, kDepth * size, z)); };
  for (int column = 0; column <= count(end.x() - begin.x()); ++column) {
    add(begin.x() + column * distance, begin.y());
    add(begin.x() + column * distance, end.y());
  }
  for (int row = 0; row <= count(end.y() - begin.y()); ++row) {
    add(begin.x(), begin.y() + row * distance);
    add(end.x(), begin.y() + row * distance);
  }
}

}  // namespace spring_pendulum
