#include "ros/inputs/frames.hpp"

#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <tf2/exceptions.h>

namespace spring_pendulum {

tf2::Matrix3x3 rotation(const geometry_msgs::Quaternion& quaternion) {
  tf2::Quaternion q(quaternion.x, quaternion.y, quaternion.z, quaternion.w);
  return q.length2() == 0.0 ? tf2::Matrix3x3::getIdentity() : tf2::Matrix3x3(q);
}

void Frames::listen() {
  if (listener_) return;
  transforms_ = std::make_unique<tf2_ros::Buffer>();
  // With a thread of its own, so that `from` can wait.
  listener_ = std::make_unique<tf2_ros::TransformListener>(*transforms_);
}

StampedTransform Frames::from(const std::string& name) {
  const std::string frame = name.empty() || name.front() != '/' ? name : name.substr(1);
  if (frame.empty() || frame == frame_id_) return {};
  // The first time, wait for half a second of the wall clock: ROS time may stand still.
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(listener_ ? 0.0 : 0.5);
  listen();
  for (;; ros::WallDuration(0.01).sleep()) {
    try {
      const auto found = transforms_->lookupTransform(frame_id_, frame, ros::Time(0));
      const geometry_msgs::Vector3& shift = found.transform.translation;
      return {tf2::Transform(rotation(found.transform.rotation),
                             tf2::Vector3(shift.x, shift.y, shift.z)),
              found.header.stamp.toSec()};
    } catch (const tf2::TransformException& error) {
      if (ros::SteadyTime::now() < end && ros::ok()) continue;
      throw InputError(
          fmt::format("no transform from frame {}: {}", inQuotes(frame), error.what()));
    }
  }
}

void Frames::forget() {
  if (transforms_) transforms_->clear();
}

}  // namespace spring_pendulum
