#include "ros/parameters.hpp"

#include <spring_pendulum/model/errors.hpp>
#include <spring_pendulum/simulation/parameters.hpp>

#include <fmt/format.h>

#include <ros/param.h>
#include <ros/this_node.h>

#include <algorithm>

namespace spring_pendulum {
namespace {

bool isScenarioKey(const std::string& key) {
  const auto& table = parameterTable();
  return std::any_of(table.begin(), table.end(),
                     [&](const Parameter& parameter) { return parameter.key == key; });
}

std::string knownKeys() {
  std::string keys;
  for (const Parameter& parameter : parameterTable()) keys += fmt::format("{}, ", parameter.key);
  for (const NodeOption& option : nodeOptionTable()) keys += fmt::format("{}, ", option.key);
  return keys.substr(0, keys.size() - 2);
}

}  // namespace

std::string parameterText(XmlRpc::XmlRpcValue& value, const std::string& key,
                          const std::string& where) {
  using XmlRpc::XmlRpcValue;
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value) ? "true" : "false";
    case XmlRpcValue::TypeInt:
      return fmt::format("{}", static_cast<int>(value));
    case XmlRpcValue::TypeDouble:
      return fmt::format("{}", static_cast<double>(value));
    case XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    default:
      throw InputError(fmt::format("{}: {} is a list, a map or binary data: must be a single value",
                                   where, key));
  }
}

NodeConfiguration readParameters(XmlRpc::XmlRpcValue& parameters, const std::string& where) {
  NodeConfiguration configuration;
  ScenarioBuilder builder;
  if (parameters.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    configuration.scenario = builder.build();
    return configuration;
  }
  for (auto& [key, value] : parameters) {
    const std::string text = parameterText(value, key, where);
    if (key == "output" && text.empty()) {
      builder.set("no_frames", "true", where);  // a launch file can't leave a parameter out
    } else if (isScenarioKey(key)) {
      builder.set(key, text, where);
    } else if (!setNodeOption(configuration.options, key, text, where)) {
      throw InputError(
          fmt::format("{}: unknown parameter '{}': known are {}", where, key, knownKeys()));
    }
  }
  configuration.scenario = builder.build();
  return configuration;
}

NodeConfiguration readPrivateParameters() {
  XmlRpc::XmlRpcValue parameters;
  ros::param::get(ros::this_node::getName(), parameters);
  return readParameters(parameters, ros::this_node::getName());
}

}  // namespace spring_pendulum
