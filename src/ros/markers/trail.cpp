#include "ros/markers/picture.hpp"
#include "ros/parameters/color.hpp"

namespace spring_pendulum {
namespace {

/// rviz crashed with more than 16384 points in a LINE_STRIP.
constexpr std::size_t kMostPoints = 4096;
/// rviz blends a line only if the colour of the marker is not opaque.
constexpr double kOpacity = 0.9;

}  // namespace

void Trail::track(const Run& run, double duration) {
  // After a change of the method, the same time may be rounded differently.
  if (!points_.empty() && run.time() < (1.0 - 1e-9) * points_.back().time) points_.clear();
  if (duration <= 0.0 || run.chain().size() < 2 || !run.isFinite() || !run.isShown()) return;
  if (!points_.empty() && run.time() == points_.back().time) return;
  points_.push_back({run.time(), pointOf(run.state(), run.chain().size() - 1)});
  while (points_.front().time < run.time() - duration || points_.size() > kMostPoints) {
    points_.pop_front();
  }
}

void Trail::draw(const Picture& picture, Marker& marker) const {
  const std::string& own = picture.options.color;
  const auto& masses = picture.run.chain().masses();
  const auto moving = masses.tail(std::max<Eigen::Index>(masses.size() - 1, 1));
  const std_msgs::ColorRGBA tip =
      lighter(massColor(masses[masses.size() - 1], moving.minCoeff(), moving.maxCoeff()));
  setScale(marker, 0.5 * picture.width());
  marker.pose.position.y = (1.0 + picture.chainsInFront()) * picture.depth();
  marker.color.a = static_cast<float>(kOpacity);
  marker.points.clear();
  marker.colors.clear();
  for (const TrailPoint& point : points_) {
    const double age = (points_.back().time - point.time) / picture.options.trail;
    std_msgs::ColorRGBA color = own.empty() ? tip : *parseColor(own);
    color.a = static_cast<float>(std::max(kOpacity * (1.0 - age), 0.02));
    marker.points.push_back(point.point);
    marker.colors.push_back(color);
  }
}

}  // namespace spring_pendulum
