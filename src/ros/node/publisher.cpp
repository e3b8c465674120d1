#include "ros/node/publisher.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <ros/publication.h>
#include <ros/topic_manager.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>

namespace spring_pendulum {
namespace {

constexpr std::int64_t kQueueBytes = 64 << 20, kLongestQueue = 1000;  // of a slow subscriber

std::uint32_t queueLength(std::int64_t message_bytes) {
  return static_cast<std::uint32_t>(
      std::clamp<std::int64_t>(kQueueBytes / message_bytes, 2, kLongestQueue));
}

/// Publishes a message, and returns its bytes.
template <typename Message>
ros::SerializedMessage send(const ros::Publisher& topic, const Message& message) {
  ros::SerializedMessage bytes;
  const auto serialize = [&message] { return ros::serialization::serializeMessage(message); };
  ros::TopicManager::instance()->publish(topic.getTopic(), serialize, bytes);
  return bytes;
}

}  // namespace

Publisher::Publisher(ros::NodeHandle& node, const Run& run, const NodeOptions& options)
    : messages_(run, options, options.publish_clock) {
  const std::int64_t particles = run.chain().size();
  const std::int64_t marker_bytes = 4096 + 128 * std::min(particles, options.display_limit);
  markers_ = node.advertise<visualization_msgs::MarkerArray>("markers", queueLength(marker_bytes));
  state_ = node.advertise<PendulumState>("state", queueLength(1024 + 48 * particles));
  status_ = node.advertise<PendulumStatus>("status", 10, true);
  for (const ros::Publisher& topic : {markers_, state_, status_})
    if (topic == nullptr) throw InputError("markers, state and status cannot share a topic");
  if (!options.camera_frame.empty())
    tf_static_ = node.advertise<tf2_msgs::TFMessage>("/tf_static", 10, true);
  if (options.publish_clock) clock_ = node.advertise<rosgraph_msgs::Clock>("/clock", 10);
}

std::int64_t Publisher::subscribers(const std::string& nodes) const {
  XmlRpc::XmlRpcValue links;  // for each subscriber: a number, its node, ...
  links.setSize(0);
  for (const ros::Publisher& topic : {markers_, state_, status_})
    ros::TopicManager::instance()->lookupPublication(topic.getTopic())->getInfo(links);
  int count = 0, size = links.size();
  for (int i = 0; i < size; ++i) {
    const std::string node = links[i][1], name = node.substr(node.rfind('/') + 1);
    if (nodes.empty() || (" " + nodes + " ").find(" " + name + " ") < nodes.size()) ++count;
  }
  return count;
}

std::optional<std_msgs::Header> Publisher::publish(const Run& run, Showing showing) {
  showing.wants_markers = markers_.getNumSubscribers() > 0;
  showing.wants_state = state_.getNumSubscribers() > 0;
  const std::optional<StateMessages> messages = messages_.build(run, showing);
  if (!messages) return std::nullopt;
  if (clock_ != nullptr) {
    rosgraph_msgs::Clock clock;
    clock.clock = messages->header.stamp;
    clock_.publish(clock);
  }
  if (messages->camera) tf_static_.publish(*messages->camera);
  if (messages->markers != nullptr) {
    last_markers_ = send(markers_, *messages->markers);
    ++markers_built_;
  }
  if (messages->state != nullptr) {
    last_state_ = send(state_, *messages->state);
    ++states_built_;
  }
  if (messages->status) status_.publish(*messages->status);
  return messages->header;
}

void Publisher::publishWaiting(const std::string& text) {
  PendulumStatus waiting;
  waiting.code = PendulumStatus::WAITING;
  waiting.text = text;
  waiting.header = messages_.header(0.0);
  status_.publish(waiting);
}

void Publisher::clear() {
  if (markers_.getNumSubscribers() == 0) return;
  visualization_msgs::MarkerArray nothing;
  nothing.markers.resize(1);
  nothing.markers.front().header = messages_.header(0.0);
  nothing.markers.front().action = visualization_msgs::Marker::DELETEALL;
  last_markers_ = send(markers_, nothing);
}

std::string Publisher::numbers() const {
  return fmt::format("{} marker and {} state messages built", markers_built_, states_built_);
}

}  // namespace spring_pendulum
