#include "ros/messages/scene_view.hpp"

#include <spring_pendulum/model/dynamics.hpp>

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

constexpr double kAspect = 1.3;         ///< least ratio of width to height of the picture
constexpr double kMargin = 0.05;        ///< around the scene, in sizes of the picture
constexpr double kTextHeight = 0.04;    ///< in sizes of the picture
constexpr double kLineDistance = 1.35;  ///< in text heights
constexpr double kGridLines = 8.0;      ///< least number in the height of the picture
const double kHalfViewTangent = std::sqrt(2.0) - 1.0;  ///< tan of rviz's half angle, 22.5 degrees

constexpr double kGrowth = 0.25;      ///< of the picture when the chain leaves it, in sizes
constexpr double kMostGrowth = 16.0;  ///< largest picture, in sizes of the first one

Box boxOf(const State& state) {
  return {state.x().minCoeff(), state.x().maxCoeff(), state.y().minCoeff(), state.y().maxCoeff()};
}

Box intersection(const Box& a, const Box& b) {
  return {std::max(a.left, b.left), std::min(a.right, b.right), std::max(a.bottom, b.bottom),
          std::min(a.top, b.top)};
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

bool contains(const Box& outer, const Box& inner) {
  return inner.left >= outer.left && inner.right <= outer.right && inner.bottom >= outer.bottom &&
         inner.top <= outer.top;
}

double sizeOf(const Box& box) {
  return std::max(box.height(), box.width() / kAspect);
}

Box padded(const Box& box, double share) {
  const double margin = share * sizeOf(box);
  return {box.left - margin, box.right + margin, box.bottom - margin, box.top + margin};
}

}  // namespace

void Box::include(const Box& other) {
  left = std::min(left, other.left);
  right = std::max(right, other.right);
  bottom = std::min(bottom, other.bottom);
  top = std::max(top, other.top);
}

SceneView::SceneView(const Run& run, bool hangs, int text_lines) : text_lines_(text_lines) {
  const State& start = run.start();
  const Eigen::Index springs = run.chain().size() - 1;
  double length = springLengths(start, 0, springs);
  if (hangs) length = std::max(length, hangingLength(run.chain()));
  if (!(length > 0.0)) length = 1.0;
  Box scene = boxOf(start);
  const double x = start.x()[0], y = start.y()[0];
  if (hangs) {
    const double end = run.chain().gravity() < 0.0 ? y + length : y - length;
    const double aside = std::max(x - scene.left, scene.right - x);
    scene.include({x - aside, x + aside, std::min(y, end), std::max(y, end)});
  }
  if (sizeOf(scene) < 0.5 * length) {
    const double half = 0.5 * length;
    scene.include({x - half, x + half, y - half, y + half});
  }
  box_ = padded(scene, kMargin);
  largest_ = padded(box_, 0.5 * (kMostGrowth - 1.0));
}

bool SceneView::widenFor(const State& state) {
  const Box chain = intersection(boxOf(state), largest_);
  if (contains(box_, chain)) return false;
  Box wider = box_;
  wider.include(chain);
  const double more = kGrowth * sizeOf(box_);
  if (wider.left < box_.left) wider.left -= more;
  if (wider.right > box_.right) wider.right += more;
  if (wider.bottom < box_.bottom) wider.bottom -= more;
  if (wider.top > box_.top) wider.top += more;
  box_ = wider;
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
  return 0.5 * (box_.bottom + box_.top + text_lines_ * lineDistance());
}

double SceneView::halfHeight() const {
  return 0.5 * std::max(box_.height() + text_lines_ * lineDistance(), box_.width() / kAspect);
}

double SceneView::cameraDistance() const {
  return halfHeight() / kHalfViewTangent;
}

}  // namespace spring_pendulum
