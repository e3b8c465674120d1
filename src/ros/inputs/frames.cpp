#include "ros/inputs/frames.hpp"

#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <ros/ros.h>

#include <algorithm>
#include <cstddef>
#include <exception>

namespace spring_pendulum {
namespace {

constexpr double kFirstWait = 0.5;   // s, for the first transforms
constexpr double kRestart = 0.5;     // s, the least jump back of a clock that starts again
constexpr double kForgetting = 1.0;  // s, at least: a frame of two sources jumps all the time

std::string withoutSlash(const std::string& frame) {
  return frame.substr(frame.rfind('/', 0) == 0 ? 1 : 0);
}

}  // namespace

tf2::Matrix3x3 rotation(const geometry_msgs::Quaternion& quaternion) {
  tf2::Quaternion q(quaternion.x, quaternion.y, quaternion.z, quaternion.w);
  return q.length2() == 0.0 ? tf2::Matrix3x3::getIdentity() : tf2::Matrix3x3(q);
}

void Frames::listen() {
  if (!moving_.getTopic().empty()) return;
  ros::NodeHandle node;
  node.setCallbackQueue(&queue_);
  const auto subscribe = [&](const char* topic, bool is_static) {
    return node.subscribe<tf2_msgs::TFMessage>(
        topic, 1000,
        [this, is_static](const tf2_msgs::TFMessage::ConstPtr& m) { take(*m, is_static); });
  };
  moving_ = subscribe("/tf", false);
  fixed_ = subscribe("/tf_static", true);
}

void Frames::take(const tf2_msgs::TFMessage& message, bool is_static) {
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    try {
      const bool stays = note(transform, is_static);
      transforms_->setTransform(transform, "tf", stays);
    } catch (const std::exception& error) {  // of tf2, for example at the ends of ROS time
      if (!warnings_.isDue()) continue;
      ROS_WARN_STREAM("tf: frame " << inQuotes(transform.child_frame_id) << ": " << error.what());
    }
  }
}

bool Frames::note(const geometry_msgs::TransformStamped& transform, bool is_static) {
  const double stamp = transform.header.stamp.toSec();
  Edge& edge = edges_[withoutSlash(transform.child_frame_id)];
  const bool stays = is_static || (stamp == 0.0 && edge.latest == 0.0);
  const bool changes = stays ? edge.latest > 0.0 : edge.fixed.has_value();
  edge.parent = withoutSlash(transform.header.frame_id);
  edge.fixed = stays ? std::optional(transform) : std::nullopt;
  edge.old_ones = !stays && stamp < edge.latest - kRestart ? edge.old_ones + 1 : 0;
  edge.latest = stays ? 0.0 : std::max(edge.latest, stamp);
  const bool restarts = edge.old_ones > 1 && edge.is_used && restarts_.isDue(kForgetting);
  if (!changes && !restarts) return stays;
  // tf2 would take new ones for the past, and keeps a frame fixed or moving.
  transforms_ = std::make_unique<tf2::BufferCore>();
  for (auto& [child, other] : edges_) {
    if (restarts) other.latest = std::min(other.latest, stamp);
    if (other.fixed) transforms_->setTransform(*other.fixed, "tf", true);
  }
  return stays;
}

StampedTransform Frames::from(const std::string& name) {
  const std::string frame = withoutSlash(name);
  if (frame.empty() || frame == frame_id_) return {};
  for (const std::string& child : {frame, frame_id_}) {
    std::size_t left = edges_.size();  // tf trees with loops are refused below
    for (auto one = edges_.find(child); one != edges_.end() && left-- > 0;
         one = edges_.find(one->second.parent))
      one->second.is_used = true;
  }
  // The first time, wait on the wall clock: ROS time may stand still.
  const ros::WallDuration longest(moving_.getTopic().empty() ? kFirstWait : 0.0);
  const ros::SteadyTime end = ros::SteadyTime::now() + longest;
  listen();
  for (ros::WallDuration wait(0.0);; wait = ros::WallDuration(0.01)) {
    queue_.callAvailable(wait);
    try {
      const auto found = transforms_->lookupTransform(frame_id_, frame, ros::Time(0));
      const geometry_msgs::Vector3& shift = found.transform.translation;
      return {tf2::Transform(rotation(found.transform.rotation),
                             tf2::Vector3(shift.x, shift.y, shift.z)),
              found.header.stamp.toSec()};
    } catch (const std::exception& error) {
      if (ros::SteadyTime::now() < end && ros::ok()) continue;
      throw InputError(
          fmt::format("no transform from frame {}: {}", inQuotes(frame), error.what()));
    }
  }
}

}  // namespace spring_pendulum
