#include "ros/markers/scene_view.hpp"

#include <spring_pendulum/model/dynamics.hpp>

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

using Box = Eigen::AlignedBox2d;
using Point = Eigen::Vector2d;

constexpr double kAspect = 1.3;         ///< least ratio of width to height of the picture
constexpr double kMargin = 0.05;        ///< around the scene, in sizes of the picture
constexpr double kTextHeight = 0.04;    ///< in sizes of the picture
constexpr double kLineDistance = 1.35;  ///< in text heights
constexpr double kGridLines = 8.0;      ///< least number in the height of the picture
const double kHalfViewTangent = std::sqrt(2.0) - 1.0;  ///< tan of rviz's half angle, 22.5 degrees

constexpr double kGrowth = 0.25;      ///< of the picture when the chain leaves it, in sizes
constexpr double kMostGrowth = 16.0;  ///< largest picture, in sizes of the first one

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
double hangingLength(const Chain& chain) {
  const SpringLaw& spring = chain.spring();
  const double relaxed = static_cast<double>(chain.size() - 1) * spring.rest_length;
  if (spring.stiffness == 0.0) return relaxed;
  double length = relaxed, weight = 0.0;
  for (Eigen::Index i = chain.size() - 1; i > 0; --i) {
    weight += chain.masses()[i] * std::abs(chain.gravity());
    length += weight / spring.stiffness;
  }
  return relaxed > 0.0 ? std::min(length, 10.0 * relaxed) : length;
}

}  // namespace

SceneView::SceneView(const Run& run, bool hangs) : box_(boxOf(run.start())) {
  const Point anchor(run.start().x()[0], run.start().y()[0]);
  double length = springLengths(run.start(), 0, run.chain().size() - 1);
  if (hangs) {
    length = std::max(length, hangingLength(run.chain()));
    const double aside =
        std::max(anchor.x() - box_.min().x(), box_.max().x() - anchor.x());  // it swings back
    box_.extend(Point(anchor.x() - aside, anchor.y()));
    box_.extend(
        Point(anchor.x() + aside, anchor.y() + (run.chain().gravity() < 0.0 ? length : -length)));
  }
  if (!(length > 0.0)) length = 1.0;
  if (sizeOf(box_) < 0.5 * length) {
    box_.extend(Point(anchor.array() - 0.5 * length)).extend(Point(anchor.array() + 0.5 * length));
  }
  box_ = padded(box_, kMargin);
  largest_ = padded(box_, 0.5 * (kMostGrowth - 1.0));
}

bool SceneView::widenFor(const State& state) {
  const Box chain = boxOf(state).intersection(largest_);
  if (box_.contains(chain)) return false;
  const Box old = box_;
  const double more = kGrowth * size();
  box_.extend(chain);
  box_.min().array() -= more * (box_.min().array() < old.min().array()).cast<double>();
  box_.max().array() += more * (box_.max().array() > old.max().array()).cast<double>();
  return true;
}

double SceneView::size() const {
  return sizeOf(box_);
}

double SceneView::textHeight() const {
  return kTextHeight * size();
}

double SceneView::lineDistance() const {
  return kLineDistance * textHeight();
}

double SceneView::gridDistance() const {
  const double largest = size() / kGridLines;
  const double power = std::pow(10.0, std::floor(std::log10(largest)));
  for (const double multiple : {5.0, 2.0}) {
    if (multiple * power <= largest) return multiple * power;
  }
  return power;
}

double SceneView::cameraHeight() const {
  return box_.center().y() + 0.5 * kTextLines * lineDistance();
}

double SceneView::cameraDistance() const {
  Box seen = box_;
  seen.max().y() += kTextLines * lineDistance();
  return 0.5 * sizeOf(seen) / kHalfViewTangent;
}

}  // namespace spring_pendulum
