#include "ros/markers/scene_view.hpp"

#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

using Box = Eigen::AlignedBox2d;
using Point = Eigen::Vector2d;

constexpr double kAspect = 1.3;     ///< least ratio of width to height of the picture
constexpr double kMargin = 0.05;    ///< around the scene, in sizes of the picture
constexpr double kGridLines = 8.0;  ///< least number in the height of the picture
const double kHalfViewTangent = std::sqrt(2.0) - 1.0;  ///< tan of rviz's half angle, 22.5 degrees

constexpr double kGrowth = 0.25;     ///< of the picture when the chain leaves it, in sizes
constexpr double kFar = 16.0;        ///< size of a picture that is too large, in sizes of the chain
constexpr double kMostGrowth = 1e3;  ///< largest chain shown, in sizes of the first picture

Box boxOf(const State& state) {
  return {Point(state.x().minCoeff(), state.y().minCoeff()),
          Point(state.x().maxCoeff(), state.y().maxCoeff())};
}

double sizeOf(const Box& box) {
  return std::max(box.sizes().y(), box.sizes().x() / kAspect);
}

Box padded(const Box& box, double share) {
  const Point margin = Point::Constant(share * sizeOf(box));
  return {Point(box.min() - margin), Point(box.max() + margin)};
}

/// Length of the chain at rest, m; at most ten times its length without forces.
double lengthAtRest(const Run& run) {
  const std::ptrdiff_t springs = run.chain().size() - 1;
  const double relaxed = static_cast<double>(springs) * run.chain().spring().rest_length;
  try {
    const double length = springLengths(equilibrium(run.chain(), run.start()), 0, springs);
    return relaxed > 0.0 ? std::min(length, 10.0 * relaxed) : length;
  } catch (const InputError&) {
    return relaxed;
  }
}

}  // namespace

SceneView::SceneView(const Run& run, bool hangs) : box(boxOf(run.start())) {
  const Point anchor(run.start().x()[0], run.start().y()[0]);
  double length = springLengths(run.start(), 0, run.chain().size() - 1);
  if (hangs) {
    length = std::max(length, lengthAtRest(run));
    const double aside =
        std::max(anchor.x() - box.min().x(), box.max().x() - anchor.x());  // it swings back
    box.extend(Point(anchor.x() - aside, anchor.y()));
    box.extend(
        Point(anchor.x() + aside, anchor.y() + (run.chain().gravity() < 0.0 ? length : -length)));
  }
  if (!(length > 0.0)) length = 1.0;
  if (sizeOf(box) < 0.5 * length)
    box.extend(Point(anchor.array() - 0.5 * length)).extend(Point(anchor.array() + 0.5 * length));
  box = padded(box, kMargin);
  start_size = size();
}

bool SceneView::widenFor(const State& state) {
  const Box all = boxOf(state), old = box;
  const double more = kGrowth * size(), now = sizeOf(all);
  if (box.contains(all) || !(now < kMostGrowth * start_size)) return false;
  box.extend(all);
  if (size() > kFar * std::max(now, start_size)) {
    const Point half = Point::Constant(0.5 * start_size);
    box = Box(Point(all.center() - half), Point(all.center() + half)).extend(all);
    return true;
  }
  box.min().array() -= more * (box.min().array() < old.min().array()).cast<double>();
  box.max().array() += more * (box.max().array() > old.max().array()).cast<double>();
  return true;
}

double SceneView::size() const {
  return sizeOf(box);
}

double SceneView::gridDistance() const {
  const double most = size() / kGridLines;
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  for (const double multiple : {5.0, 2.0})
    if (multiple * power <= most) return multiple * power;
  return power;
}

double SceneView::cameraDistance() const {
  Box seen = box;
  seen.max().y() += kTextLines * lineDistance();
  return 0.5 * sizeOf(seen) / kHalfViewTangent;
}

}  // namespace spring_pendulum
