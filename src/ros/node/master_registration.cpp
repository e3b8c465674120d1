#include "ros/node/master_registration.hpp"

#include <ros/console.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/time.h>

namespace spring_pendulum {
namespace {

constexpr double kInterval = 1.0;  // s between two queries
constexpr double kNap = 0.05;      // s, latency of the end of the thread

/// Queries the master once; does not wait for an absent master.
bool ask(const std::string& method, const std::vector<std::string>& arguments,
         XmlRpc::XmlRpcValue* answer = nullptr) {
  XmlRpc::XmlRpcValue request, response, payload;
  for (std::size_t i = 0; i < arguments.size(); ++i) request[static_cast<int>(i)] = arguments[i];
  if (!ros::master::execute(method, request, response, payload, false)) return false;
  if (answer != nullptr) *answer = payload;
  return true;
}

/// The text in the answer of the master; empty: none.
std::string lookUp(const std::string& method, const std::string& name) {
  XmlRpc::XmlRpcValue answer;
  if (!ask(method, {ros::this_node::getName(), name}, &answer)) return "";
  return answer.getType() == XmlRpc::XmlRpcValue::TypeString ? std::string(answer) : "";
}

}  // namespace

void MasterRegistration::addTopic(const std::string& topic, const std::string& type) {
  topics_.push_back({topic, type});
}

void MasterRegistration::addService(const std::string& service) {
  services_.push_back({service, lookUp("lookupService", service)});
}

void MasterRegistration::keep() {
  node_uri_ = lookUp("lookupNode", ros::this_node::getName());
  if (!node_uri_.empty()) thread_ = std::thread([this] { watch(); });
}

void MasterRegistration::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

void MasterRegistration::watch() {
  ros::SteadyTime next_question = ros::SteadyTime::now() + ros::WallDuration(kInterval);
  while (!stopping_ && ros::ok()) {
    ros::WallDuration(kNap).sleep();
    if (ros::SteadyTime::now() < next_question) continue;
    if (lookUp("lookupNode", ros::this_node::getName()).empty()) renew();
    next_question = ros::SteadyTime::now() + ros::WallDuration(kInterval);
  }
}

void MasterRegistration::renew() const {
  const std::string& node = ros::this_node::getName();
  for (const Topic& topic : topics_) {
    if (!ask("registerPublisher", {node, topic.name, topic.type, node_uri_})) return;
  }
  for (const Service& service : services_) {
    ask("registerService", {node, service.name, service.uri, node_uri_});
  }
  ROS_WARN("the ROS master was restarted: registered %zu topics and %zu services again",
           topics_.size(), services_.size());
}

}  // namespace spring_pendulum
