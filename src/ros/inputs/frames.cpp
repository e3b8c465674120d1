#include "ros/inputs/frames.hpp"

#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <tf2/exceptions.h>

namespace spring_pendulum {

geometry_msgs::Vector3 rotated(const geometry_msgs::Quaternion& q, double x, double y, double z) {
  // v + 2/|q|² u × (u × v + w v) with q = (u, w)
  const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  const double factor = square > 0.0 ? 2.0 / square : 0.0;
  const double ax = q.y * z - q.z * y + q.w * x;
  const double ay = q.z * x - q.x * z + q.w * y;
  const double az = q.x * y - q.y * x + q.w * z;
  geometry_msgs::Vector3 result;
  result.x = x + factor * (q.y * az - q.z * ay);
  result.y = y + factor * (q.z * ax - q.x * az);
  result.z = z + factor * (q.x * ay - q.y * ax);
  return result;
}

void Frames::listen() {
  if (listener_) return;
  transforms_ = std::make_unique<tf2_ros::Buffer>();
  // With a thread of its own, so that `from` can wait.
  listener_ = std::make_unique<tf2_ros::TransformListener>(*transforms_);
}

geometry_msgs::TransformStamped Frames::from(const std::string& name) {
  const std::string frame = name.empty() || name.front() != '/' ? name : name.substr(1);
  if (frame.empty() || frame == frame_id_) {
    geometry_msgs::TransformStamped none;
    none.transform.rotation.w = 1.0;
    return none;
  }
  // The first time, wait for half a second of the wall clock: ROS time may stand still.
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(listener_ ? 0.0 : 0.5);
  listen();
  for (;; ros::WallDuration(0.01).sleep()) {
    try {
      return transforms_->lookupTransform(frame_id_, frame, ros::Time(0));
    } catch (const tf2::TransformException& error) {
      if (ros::SteadyTime::now() < end && ros::ok()) continue;
      throw InputError(
          fmt::format("no transform from frame {}: {}", inQuotes(frame), error.what()));
    }
  }
}

}  // namespace spring_pendulum
