#include "ros/node/publisher.hpp"

#include "base/numbers.hpp"
#include "io/program/program.hpp"

#include <fmt/format.h>

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>

namespace spring_pendulum {
namespace {

constexpr double kPollInterval = 0.01;    // s between two checks for subscribers
constexpr double kLongestDuration = 1e9;  // s; ros::Duration has 32 bits for seconds

/// Limit of the queue of states, bytes. A slow subscriber loses messages instead of increasing the
/// memory of the node.
constexpr std::int64_t kQueueBytes = 64 << 20;
constexpr std::int64_t kLongestQueue = 1000;

std::uint32_t queueLength(std::int64_t message_bytes) {
  return static_cast<std::uint32_t>(
      std::clamp<std::int64_t>(kQueueBytes / message_bytes, 2, kLongestQueue));
}

}  // namespace

Publisher::Publisher(ros::NodeHandle& node, const Run& run, const NodeOptions& options)
    : publishes_clock_(options.publish_clock), messages_(run, options, options.publish_clock) {
  const std::int64_t particles = run.chain().size();
  const std::int64_t state_bytes = 1024 + 48 * particles;
  const std::int64_t marker_bytes = 4096 + 128 * std::min(particles, options.display_limit);
  markers_ = node.advertise<visualization_msgs::MarkerArray>("markers", queueLength(marker_bytes));
  state_ = node.advertise<PendulumState>("state", queueLength(state_bytes));
  status_ = node.advertise<PendulumStatus>("status", 10, true);
  if (!options.camera_frame.empty()) {
    tf_static_ = node.advertise<tf2_msgs::TFMessage>("/tf_static", 10, true);
  }
  if (publishes_clock_) clock_ = node.advertise<rosgraph_msgs::Clock>("/clock", 10);
}

void Publisher::waitForSubscribers(const NodeOptions& options) {
  const ros::SteadyTime start = ros::SteadyTime::now();
  const ros::WallDuration timeout(std::min(options.wait_timeout, kLongestDuration));
  const auto subscribers = [this] {
    return markers_.getNumSubscribers() + state_.getNumSubscribers() + status_.getNumSubscribers();
  };
  if (subscribers() >= options.wait_for_subscribers) return;
  PendulumStatus waiting;
  waiting.code = PendulumStatus::WAITING;
  waiting.text = "waiting for " + counted(options.wait_for_subscribers, "subscriber");
  ROS_INFO_STREAM(waiting.text << " of markers, state and status (wait_for_subscribers)");
  waiting.header = messages_.header(0.0);
  status_.publish(waiting);
  while (ros::ok() && interruption() == 0 && subscribers() < options.wait_for_subscribers) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kPollInterval));
    if (timeout.isZero() || ros::SteadyTime::now() - start < timeout) continue;
    ROS_WARN("only %u of %ld subscribers after %.6g s (wait_timeout): starting anyway",
             subscribers(), static_cast<long>(options.wait_for_subscribers), options.wait_timeout);
    return;
  }
}

void Publisher::start(const std_msgs::Header& header) {
  if (!publishes_clock_) return;
  rosgraph_msgs::Clock clock;
  clock.clock = header.stamp;
  clock_.publish(clock);
}

void Publisher::put(const visualization_msgs::MarkerArray& markers) {
  markers_.publish(markers);
  ++markers_built_;
}

void Publisher::put(const PendulumState& state) {
  state_.publish(state);
  ++states_built_;
}

void Publisher::clear() {
  if (!wantsMarkers()) return;
  visualization_msgs::MarkerArray nothing;
  nothing.markers.resize(1);
  nothing.markers.front().header = messages_.header(0.0);
  nothing.markers.front().action = visualization_msgs::Marker::DELETEALL;
  markers_.publish(nothing);
}

std::string Publisher::numbers() const {
  return fmt::format("{} marker and {} state messages built", markers_built_, states_built_);
}

}  // namespace spring_pendulum
