#include "ros/node/publisher.hpp"

#include "base/numbers.hpp"
#include "io/program/interruption.hpp"

#include <fmt/format.h>

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <tf2_msgs/TFMessage.h>

namespace spring_pendulum {
namespace {

constexpr double kPollInterval = 0.01;  // s between two checks for subscribers
constexpr double kLongestWait = 1e9;    // s; ros::Duration has 32 bits for seconds

/// Limit of the queue of states, bytes. A slow subscriber loses messages instead of increasing the
/// memory of the node.
constexpr std::int64_t kQueueBytes = 64 << 20;
constexpr std::int64_t kLongestQueue = 1000;

std::uint32_t queueLength(std::int64_t message_bytes) {
  return static_cast<std::uint32_t>(
      std::clamp<std::int64_t>(kQueueBytes / message_bytes, 2, kLongestQueue));
}

}  // namespace

PendulumStatus statusOf(const Run& run, bool paused) {
  PendulumStatus status;
  const Verdict& verdict = run.verdict();
  setPositionError(run, status);
  if (!run.isShown()) {
    status.code = PendulumStatus::DIVERGED;
    status.text = verdict.text;
    return status;
  }
  if (run.isOver()) {
    status.code = PendulumStatus::FINISHED;
    status.text = fmt::format("finished: {}, {:.6g} s, {}", counted(run.frame() + 1, "frame"),
                              run.time(), run.measurements());
  } else if (paused) {
    status.code = PendulumStatus::PAUSED;
    status.text = fmt::format("paused at frame {}, t = {:.6g} s", run.frame(), run.time());
  } else {
    status.code = PendulumStatus::RUNNING;
    status.text =
        fmt::format("running, {} to t = {:.6g} s", counted(run.scenario().frames, "frame"),
                    frameSteps(run.scenario()).timeOfFrame(run.scenario().frames - 1));
  }
  status.text += ", verdict: " + verdict.text;
  return status;
}

Publisher::Publisher(ros::NodeHandle& node, const Run& run, const NodeOptions& options)
    : frame_id_(options.frame_id),
      camera_frame_(options.camera_frame),
      publishes_clock_(options.publish_clock),
      stamps_(options.publish_clock),
      marker_builder_(run, options),
      state_builder_(options.y_offset) {
  const std::int64_t particles = run.chain().size();
  const std::int64_t state_bytes = 1024 + 48 * particles;
  const std::int64_t marker_bytes = 4096 + 128 * std::min(particles, options.display_limit);
  markers_ = node.advertise<visualization_msgs::MarkerArray>("markers", queueLength(marker_bytes));
  state_ = node.advertise<PendulumState>("state", queueLength(state_bytes));
  status_topic_ = node.advertise<PendulumStatus>("status", 10, true);
  if (!camera_frame_.empty()) {
    tf_static_ = node.advertise<tf2_msgs::TFMessage>("/tf_static", 10, true);
  }
  if (publishes_clock_) clock_ = node.advertise<rosgraph_msgs::Clock>("/clock", 10);
}

std::uint32_t Publisher::subscribers() const {
  return markers_.getNumSubscribers() + state_.getNumSubscribers() +
         status_topic_.getNumSubscribers();
}

bool Publisher::isWatched() const {
  return publishes_clock_ || markers_.getNumSubscribers() + state_.getNumSubscribers() > 0;
}

void Publisher::waitForSubscribers(const NodeOptions& options) {
  const ros::SteadyTime start = ros::SteadyTime::now();
  const ros::WallDuration timeout(std::min(options.wait_timeout, kLongestWait));
  const auto is_ready = [&] { return subscribers() >= options.wait_for_subscribers; };
  if (is_ready()) return;
  PendulumStatus waiting;
  waiting.code = PendulumStatus::WAITING;
  waiting.text = "waiting for " + counted(options.wait_for_subscribers, "subscriber");
  ROS_INFO_STREAM(waiting.text << " of markers, state and status (wait_for_subscribers)");
  publishStatus(waiting, stamps_.next(0.0));
  while (ros::ok() && interruption() == 0 && !is_ready()) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kPollInterval));
    if (timeout.isZero() || ros::SteadyTime::now() - start < timeout) continue;
    ROS_WARN("only %u of %ld subscribers after %.6g s (wait_timeout): starting anyway",
             subscribers(), static_cast<long>(options.wait_for_subscribers), options.wait_timeout);
    return;
  }
}

void Publisher::publish(const Run& run, const Showing& showing) {
  const PendulumStatus status = statusOf(run, showing.paused);
  if (markers_.getNumSubscribers() > 0) shown_.set(run, showing.share);
  if (!showing.due && !isNew(status)) return;
  std_msgs::Header header;
  header.frame_id = frame_id_;
  header.stamp = stamps_.next(run.time());
  if (publishes_clock_) {
    rosgraph_msgs::Clock clock;
    clock.clock = header.stamp;
    clock_.publish(clock);
  }
  marker_builder_.trackTip(run);
  if (markers_.getNumSubscribers() > 0 && showing.share >= 1.0) {
    publishMarkers(run, header, showing.pace);
  }
  if (state_.getNumSubscribers() > 0) {
    state_.publish(state_builder_.build(run, header));
    ++states_built_;
  }
  if (isNew(status)) publishStatus(status, header.stamp);
}

void Publisher::publishBetween(const Run& run, const Showing& showing) {
  if (markers_.getNumSubscribers() == 0) return;
  shown_.set(run, showing.share);
  std_msgs::Header header;
  header.frame_id = frame_id_;
  header.stamp = stamps_.next(run.time());
  publishMarkers(run, header, showing.pace);
}

void Publisher::publishMarkers(const Run& run, const std_msgs::Header& header,
                               const std::string& pace) {
  const visualization_msgs::MarkerArray& markers = marker_builder_.build(run, shown_, header, pace);
  if (!camera_frame_.empty() && marker_builder_.cameraChanges() != camera_changes_sent_) {
    camera_changes_sent_ = marker_builder_.cameraChanges();
    tf2_msgs::TFMessage message;
    message.transforms = {marker_builder_.camera(header)};
    tf_static_.publish(message);
  }
  markers_.publish(markers);
  ++markers_built_;
}

void Publisher::clear() {
  if (markers_.getNumSubscribers() == 0) return;
  visualization_msgs::MarkerArray nothing;
  nothing.markers.resize(1);
  nothing.markers.front().header.frame_id = frame_id_;
  nothing.markers.front().header.stamp = stamps_.next(0.0);
  nothing.markers.front().action = visualization_msgs::Marker::DELETEALL;
  markers_.publish(nothing);
}

bool Publisher::isNew(const PendulumStatus& status) const {
  return !status_sent_ || status.code != status_.code || status.text != status_.text;
}

void Publisher::publishStatus(PendulumStatus status, const ros::Time& stamp) {
  status.header.frame_id = frame_id_;
  status.header.stamp = stamp;
  status_ = status;
  status_sent_ = true;
  status_topic_.publish(status_);
}

}  // namespace spring_pendulum
