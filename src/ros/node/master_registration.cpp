#include "ros/node/master_registration.hpp"

#include <fmt/format.h>

#include <ros/console.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/time.h>
#include <ros/xmlrpc_manager.h>

namespace spring_pendulum {
namespace {

using XmlRpc::XmlRpcValue;

constexpr double kInterval = 1.0;  // s between two queries
constexpr double kNap = 0.05;      // s, latency of the end of the thread

XmlRpcValue listOf(const std::vector<std::string>& texts) {
  XmlRpcValue list;
  for (std::size_t i = 0; i < texts.size(); ++i) list[static_cast<int>(i)] = texts[i];
  return list;
}

/// Queries the master once; does not wait for an absent master.
/// \returns an invalid value if it has no answer
XmlRpcValue ask(const std::string& method, const std::vector<std::string>& arguments = {}) {
  std::vector<std::string> all = arguments;
  all.insert(all.begin(), ros::this_node::getName());
  XmlRpcValue response, payload;
  if (!ros::master::execute(method, listOf(all), response, payload, false)) return {};
  return payload;
}

/// Tells roscpp who publishes a topic, as the master does when that changes.
void announcePublishers(const std::string& topic, XmlRpcValue& publishers) {
  std::string host;
  std::uint32_t port = 0;
  ros::network::splitURI(ros::XMLRPCManager::instance()->getServerURI(), host, port);
  XmlRpcValue arguments = listOf({"/master", topic}), result;
  arguments[2] = publishers;
  XmlRpc::XmlRpcClient(host.c_str(), static_cast<int>(port), "/")
      .execute("publisherUpdate", arguments, result);
}

}  // namespace

MasterRegistration::MasterRegistration() {
  record();
  if (!entries_.empty()) thread_ = std::thread([this] { watch(); });
}

MasterRegistration::~MasterRegistration() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

void MasterRegistration::record() {
  XmlRpcValue state = ask("getSystemState"), typed = ask("getTopicTypes");
  if (!state.valid() || !typed.valid()) return;
  std::map<std::string, std::string> types;
  const int number_typed = typed.size();
  for (int i = 0; i < number_typed; ++i) types[typed[i][0]] = std::string(typed[i][1]);
  const char* const methods[] = {"registerPublisher", "registerSubscriber", "registerService"};
  for (int kind = 0; kind < 3; ++kind) {
    for (int i = 0; i < state[kind].size(); ++i) {
      const std::string name = state[kind][i][0];
      std::vector<std::string> others;
      bool is_ours = false;
      XmlRpcValue& nodes = state[kind][i][1];
      const int number_of_nodes = nodes.size();
      for (int n = 0; n < number_of_nodes; ++n) {
        const std::string node = nodes[n];
        is_ours = is_ours || node == ros::this_node::getName();
        if (node != ros::this_node::getName()) others.push_back(node);
      }
      if (!is_ours) continue;
      const bool is_service = kind == 2;
      entries_.push_back({methods[kind], name,
                          is_service ? std::string(ask("lookupService", {name})) : types[name]});
      const bool is_shared = name == "/rosout" || name == "/tf_static" || kind != 0;
      for (const std::string& node : others) {
        if (!is_shared) rivals_[node].push_back(name);
      }
    }
  }
}

void MasterRegistration::watch() {
  ros::SteadyTime next_question = ros::SteadyTime::now() + ros::WallDuration(kInterval);
  while (!stopping_ && ros::ok()) {
    ros::WallDuration(kNap).sleep();
    if (ros::SteadyTime::now() < next_question) continue;
    if (!ask("lookupNode", {ros::this_node::getName()}).valid()) renew();
    next_question = ros::SteadyTime::now() + ros::WallDuration(kInterval);
  }
}

void MasterRegistration::renew() const {
  for (const Entry& entry : entries_) {
    XmlRpcValue answer = ask(
        entry.method, {entry.name, entry.details, ros::XMLRPCManager::instance()->getServerURI()});
    if (!answer.valid()) return;
    if (entry.method == "registerSubscriber") announcePublishers(entry.name, answer);
  }
  ROS_WARN("the ROS master was restarted: registered %zu topics and services again",
           entries_.size());
}

}  // namespace spring_pendulum
