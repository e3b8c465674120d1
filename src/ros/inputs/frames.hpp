// Inputs in other tf frames: brings them into the frame of the chain.
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/Vector3.h>

#include <memory>
#include <string>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

namespace spring_pendulum {

/// Rotates a vector by a quaternion of any length; 0 does not rotate.
geometry_msgs::Vector3 rotated(const geometry_msgs::Quaternion& q, double x, double y, double z);

/// Transforms a point.
template <typename Point>
geometry_msgs::Vector3 transformed(const geometry_msgs::Transform& transform, const Point& point) {
  geometry_msgs::Vector3 result = rotated(transform.rotation, point.x, point.y, point.z);
  result.x += transform.translation.x;
  result.y += transform.translation.y;
  result.z += transform.translation.z;
  return result;
}

/// Listens to tf from the first frame on that is not the frame of the chain.
class Frames {
 public:
  /// \param frame_id frame of the chain
  explicit Frames(std::string frame_id) : frame_id_(std::move(frame_id)) {}

  void listen();
  /// Returns the latest transform from a frame into the frame of the chain; an empty name means the
  /// latter, and a leading '/' does not count. Waits for half a second the first time.
  /// \throws InputError if there is no transform
  geometry_msgs::TransformStamped from(const std::string& name);

 private:
  std::string frame_id_;
  std::unique_ptr<tf2_ros::Buffer> transforms_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
};

}  // namespace spring_pendulum
