#include "ros/messages/scene_view.hpp"

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

constexpr double kAspect = 1.3;         ///< least ratio of width to height of the picture
constexpr double kMargin = 0.05;        ///< around the scene, in sizes of the picture
constexpr double kTextHeight = 0.04;    ///< in sizes of the picture
constexpr double kLineDistance = 1.35;  ///< in text heights
constexpr double kRowReach = 1.2;       ///< in half heights; the window of rviz is 1.27 wide
constexpr double kGridLines = 8.0;      ///< least number in the height of the picture
const double kHalfViewTangent = std::sqrt(2.0) - 1.0;  ///< tan of rviz's half angle, 22.5 degrees

constexpr double kMostReaches = 4.0;  ///< largest shown distance from the anchor
constexpr double kGrowth = 0.25;      ///< relative growth of the frame when the chain leaves it
constexpr double kMostGrowth = 3.0;   ///< largest size of the frame, in extents of the motion
constexpr double kMostWork = 8e-3;    ///< of the probe, s, see Integrator::work
constexpr double kLargestProbeStep = 0.02;  // s

Box boxOf(const State& state) {
  return {state.x().minCoeff(), state.x().maxCoeff(), state.y().minCoeff(), state.y().maxCoeff()};
}

Box intersection(const Box& a, const Box& b) {
  return {std::max(a.left, b.left), std::min(a.right, b.right), std::max(a.bottom, b.bottom),
          std::min(a.top, b.top)};
}

/// The larger of the length at the start and the sum of rest lengths, m; never 0.
double reachOf(const Chain& chain, const State& start) {
  const Eigen::Index springs = chain.size() - 1;
  const double reach = std::max(springLengths(start, 0, springs),
                                static_cast<double>(springs) * chain.spring().rest_length);
  return reach > 0.0 ? reach : 1.0;
}

/// The square around the anchor.
Box around(const State& start, double distance) {
  const double x = start.x()[0], y = start.y()[0];
  return {x - distance, x + distance, y - distance, y + distance};
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

/// Stable step size of Runge-Kutta-4, s: for a spring between two particles of the least mass; 0 if
/// the springs are too fast.
double probeStep(const Chain& chain) {
  const double mass = chain.masses().tail(chain.size() - 1).minCoeff();
  const double frequency = 2.0 * std::sqrt(chain.spring().stiffness / mass);
  const double rate = 4.0 * chain.spring().damping / mass;
  return std::min(kLargestProbeStep, 1.0 / (frequency + rate));
}

/// Bounds of the motion within `duration` s, or within a bounded work.
Box probeMotion(const Chain& chain, const State& start, double duration) {
  Box box = boxOf(start);
  if (chain.size() < 2) return box;
  const double step = probeStep(chain);
  if (step == 0.0) return box;
  const auto integrator = makeIntegrator("Runge-Kutta-4", chain);
  State state = start;
  constexpr int kStepsPerLook = 4;
  const double looks = std::floor(duration / step) / kStepsPerLook;
  for (double look = 0.0; look < looks && integrator->work() < kMostWork; ++look) {
    integrator->advance(state, step, kStepsPerLook);
    if (!state.values().allFinite()) break;
    box.include(boxOf(state));
  }
  return box;
}

}  // namespace

void Box::include(const Box& other) {
  left = std::min(left, other.left);
  right = std::max(right, other.right);
  bottom = std::min(bottom, other.bottom);
  top = std::max(top, other.top);
}

SceneView::SceneView(const Run& run, int text_lines) : text_lines_(text_lines) {
  const Scenario& scenario = run.scenario();
  const State& start = run.start();
  const double reach = reachOf(run.chain(), start);
  const double duration = frameSteps(scenario).timeOfFrame(scenario.frames - 1);
  Box scene =
      intersection(probeMotion(run.chain(), start, duration), around(start, kMostReaches * reach));
  scene.include(boxOf(start));
  if (sizeOf(scene) < 0.1 * reach) scene.include(around(start, 0.5 * reach));
  box_ = padded(scene, kMargin);
  largest_ = padded(box_, 0.5 * (kMostGrowth - 1.0));
  largest_.include(around(start, kMostGrowth * kMostReaches * reach));
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

double SceneView::rowReach() const {
  return kRowReach * halfHeight();
}

double SceneView::cameraDistance() const {
  return halfHeight() / kHalfViewTangent;
}

}  // namespace spring_pendulum
