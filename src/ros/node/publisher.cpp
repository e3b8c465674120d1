#include "ros/node/publisher.hpp"

#include "base/numbers.hpp"
#include "io/program/interruption.hpp"

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <optional>

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
    : publishes_clock_(options.publish_clock), build_(run, options, options.publish_clock) {
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

std::uint32_t Publisher::subscribers() const {
  return markers_.getNumSubscribers() + state_.getNumSubscribers() + status_.getNumSubscribers();
}

bool Publisher::isWatched() const {
  return publishes_clock_ || markers_.getNumSubscribers() + state_.getNumSubscribers() > 0;
}

void Publisher::waitForSubscribers(const NodeOptions& options) {
  const ros::SteadyTime start = ros::SteadyTime::now();
  const ros::WallDuration timeout(std::min(options.wait_timeout, kLongestDuration));
  const auto is_ready = [&] { return subscribers() >= options.wait_for_subscribers; };
  if (is_ready()) return;
  PendulumStatus waiting;
  waiting.code = PendulumStatus::WAITING;
  waiting.text = "waiting for " + counted(options.wait_for_subscribers, "subscriber");
  ROS_INFO_STREAM(waiting.text << " of markers, state and status (wait_for_subscribers)");
  waiting.header = build_.header(0.0);
  status_.publish(waiting);
  while (ros::ok() && interruption() == 0 && !is_ready()) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kPollInterval));
    if (timeout.isZero() || ros::SteadyTime::now() - start < timeout) continue;
    ROS_WARN("only %u of %ld subscribers after %.6g s (wait_timeout): starting anyway",
             subscribers(), static_cast<long>(options.wait_for_subscribers), options.wait_timeout);
    return;
  }
}

std::optional<std_msgs::Header> Publisher::publish(const Run& run, const Showing& showing) {
  std::optional<PendulumStatus> status = build_.newStatus(run, showing.paused);
  const bool has_markers = markers_.getNumSubscribers() > 0;
  if (!showing.due && !status) return std::nullopt;
  const std_msgs::Header header = build_.header(run.time());
  if (publishes_clock_) {
    rosgraph_msgs::Clock clock;
    clock.clock = header.stamp;
    clock_.publish(clock);
  }
  build_.trackTip(run);
  if (has_markers) publishMarkers(run, header, showing.pace);
  if (state_.getNumSubscribers() > 0) {
    state_.publish(build_.state(run, header));
    ++states_built_;
  }
  if (!status) return header;
  status->header = header;
  status_.publish(*status);
  return header;
}

void Publisher::publishMarkers(const Run& run, const std_msgs::Header& header,
                               const std::string& pace) {
  const visualization_msgs::MarkerArray& markers = build_.markers(run, header, pace);
  if (const auto camera = build_.newCamera(header)) tf_static_.publish(*camera);
  markers_.publish(markers);
  ++markers_built_;
}

void Publisher::clear() {
  if (markers_.getNumSubscribers() == 0) return;
  visualization_msgs::MarkerArray nothing;
  nothing.markers.resize(1);
  nothing.markers.front().header = build_.header(0.0);
  nothing.markers.front().action = visualization_msgs::Marker::DELETEALL;
  markers_.publish(nothing);
}

}  // namespace spring_pendulum
