#include "ros/inputs/frames.hpp"

#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <ros/ros.h>

#include <algorithm>
#include <exception>

namespace spring_pendulum {
namespace {

constexpr double kFirstWait = 0.5;   // s, for the first transforms
constexpr double kRestart = 0.5;     // s, the least jump back of a clock that starts again
constexpr double kForgetting = 1.0;  // s, at least: a frame of two sources jumps all the time

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
      if (!is_static) note(transform);
      transforms_.setTransform(transform, "tf", is_static);
    } catch (const std::exception& error) {  // of tf2, for example at the ends of ROS time
      if (!warnings_.isDue()) continue;
      ROS_WARN_STREAM("tf: frame " << inQuotes(transform.child_frame_id) << ": " << error.what());
    }
  }
}

void Frames::note(const geometry_msgs::TransformStamped& transform) {
  const double stamp = transform.header.stamp.toSec();
  auto& [latest, old_ones] = latest_[transform.child_frame_id];
  old_ones = stamp > 0.0 && stamp < latest - kRestart ? old_ones + 1 : 0;
  latest = std::max(latest, stamp);
  timeless_.erase(transform.child_frame_id);
  if (latest == 0.0) timeless_.emplace(transform.child_frame_id, transform);
  if (old_ones < 2 || !restarts_.isDue(kForgetting)) return;
  transforms_.clear();  // tf would take the new ones for the past
  latest_.clear();
  for (const auto& [frame, one] : timeless_) transforms_.setTransform(one, "tf");
}

StampedTransform Frames::from(const std::string& name) {
  const std::string frame = name.empty() || name.front() != '/' ? name : name.substr(1);
  if (frame.empty() || frame == frame_id_) return {};
  // The first time, wait on the wall clock: ROS time may stand still.
  const ros::WallDuration longest(moving_.getTopic().empty() ? kFirstWait : 0.0);
  const ros::SteadyTime end = ros::SteadyTime::now() + longest;
  listen();
  for (ros::WallDuration wait(0.0);; wait = ros::WallDuration(0.01)) {
    queue_.callAvailable(wait);
    try {
      const auto found = transforms_.lookupTransform(frame_id_, frame, ros::Time(0));
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
