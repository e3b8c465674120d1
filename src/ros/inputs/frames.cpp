#include "ros/inputs/frames.hpp"

#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <ros/ros.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <set>

namespace spring_pendulum {
namespace {

constexpr double kFirstWait = 0.5;      // s, for the first transforms
constexpr double kRestart = 0.5;        // s, the least jump back of a clock that starts again
constexpr double kForgetting = 1.0;     // s, at least: a frame of two sources jumps all the time
constexpr std::size_t kMostKept = 200;  // transforms of a frame, for common times with other frames

std::string withoutSlash(const std::string& frame) {
  return frame.substr(frame.rfind('/', 0) == 0 ? 1 : 0);
}

/// Returns a rotation by a quaternion of any length; 0 does not rotate.
tf2::Matrix3x3 rotation(const geometry_msgs::Quaternion& quaternion) {
  tf2::Quaternion q(quaternion.x, quaternion.y, quaternion.z, quaternion.w);
  return q.length2() == 0.0 ? tf2::Matrix3x3::getIdentity() : tf2::Matrix3x3(q);
}

}  // namespace

void Frames::listen() {
  if (!moving_.getTopic().empty()) return;
  // On the wall clock: ROS time may stand still.
  waits_until_ = ros::SteadyTime::now() + ros::WallDuration(kFirstWait);
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
      // tf2 says why it refuses one.
      if (tf2::BufferCore().setTransform(transform, "tf", is_static)) note(transform, is_static);
    } catch (const std::exception& error) {  // of tf2, for example at the ends of ROS time
      if (warnings_.isDue())
        ROS_WARN_STREAM("tf: frame " << inQuotes(transform.child_frame_id) << ": " << error.what());
    }
  }
}

void Frames::note(const geometry_msgs::TransformStamped& transform, bool is_static) {
  const double stamp = transform.header.stamp.toSec();
  const auto& [place, is_new] = edges_.try_emplace(withoutSlash(transform.child_frame_id));
  Edge& edge = place->second;
  const bool was_fixed = std::exchange(edge.is_fixed, is_static || stamp == 0.0);
  edge.old_ones = !edge.is_fixed && stamp < edge.latest - kRestart ? edge.old_ones + 1 : 0;
  edge.latest = edge.is_fixed ? 0.0 : std::max(edge.latest, stamp);
  if (edge.old_ones > 1 || (!is_new && was_fixed != edge.is_fixed)) edge.is_outdated = true;
  const bool goes_back = !is_new && stamp < edge.kept.back().header.stamp.toSec() - kRestart;
  if (goes_back || edge.is_fixed || was_fixed) edge.kept.clear();
  edge.kept.push_back(transform);
  if (edge.kept.size() > kMostKept) edge.kept.pop_front();
  if (edge.old_ones < 2) transforms_->setTransform(transform, "tf", edge.is_fixed);
}

void Frames::renew(const std::string& frame) {
  double now = -1.0;  // s, by the clock that has started again
  std::set<std::string> way;
  for (std::string child : {frame, frame_id_})
    for (auto one = edges_.find(child); one != edges_.end() && way.insert(child).second;
         one = edges_.find(child)) {
      const std_msgs::Header& last = one->second.kept.back().header;
      if (one->second.is_outdated && renewals_[child].isDue(kForgetting))
        now = std::max(now, (one->second.is_fixed ? ros::TIME_MAX : last.stamp).toSec());
      child = withoutSlash(last.frame_id);
    }
  if (now < 0.0) return;
  transforms_ = std::make_unique<tf2::BufferCore>();
  for (const auto& [child, edge] : std::exchange(edges_, {}))
    if (way.count(child) == 0 || edge.is_fixed ||
        edge.kept.back().header.stamp.toSec() <= now + kRestart)
      for (const auto& transform : edge.kept) note(transform, edge.is_fixed);
}

StampedTransform Frames::from(const std::string& name) {
  const std::string frame = withoutSlash(name);
  if (frame.empty() || frame == frame_id_) return {};
  listen();
  for (double wait = 0.0;; wait = 0.01) {
    receive(wait);
    renew(frame);
    try {
      const auto found = transforms_->lookupTransform(frame_id_, frame, ros::Time(0));
      const geometry_msgs::Vector3& shift = found.transform.translation;
      return {tf2::Transform(rotation(found.transform.rotation),
                             tf2::Vector3(shift.x, shift.y, shift.z)),
              found.header.stamp.toSec()};
    } catch (const std::exception& e) {
      if (ros::SteadyTime::now() < waits_until_ && ros::ok()) continue;
      throw InputError(fmt::format("no transform from frame {}: {}", inQuotes(frame), e.what()));
    }
  }
}

}  // namespace spring_pendulum
