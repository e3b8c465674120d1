#include "ros/parameters/parameters.hpp"

#include "base/numbers.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <ros/master.h>
#include <ros/param.h>
#include <ros/this_node.h>

namespace spring_pendulum {
std::string parameterText(XmlRpc::XmlRpcValue& value, const std::string& key,
                          const std::string& where) {
  using XmlRpc::XmlRpcValue;
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value) ? "true" : "false";
    case XmlRpcValue::TypeInt:
      return fmt::format("{}", static_cast<int>(value));
    case XmlRpcValue::TypeDouble:
      return numberText(static_cast<double>(value));
    case XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    default:
      throw InputError(fmt::format(
          "{}: {}: must be a single value, got a list, a map or binary data", where, key));
  }
}

NodeConfiguration readParameters(XmlRpc::XmlRpcValue& parameters, const std::string& where) {
  NodeConfiguration configuration;
  OptionSet options(scenarioOptions(configuration.scenario));
  options.add(displayOptions(configuration.options));
  options.add(playOptions(configuration.options));
  if (parameters.getType() == XmlRpc::XmlRpcValue::TypeStruct) {
    for (auto& [key, value] : parameters) {
      const std::string text = parameterText(value, key, where);
      const std::string place = fmt::format("{}: {}", where, key);
      if (key == "output" && text.empty()) {  // a launch file can't omit a parameter
        options.set(options.find("no_frames", where), "true", place);
      } else {
        options.set(options.find(key, where), text, place);
      }
    }
  }
  checkScenario(configuration.scenario);
  for (const std::string_view key : unusedKeys(configuration.scenario, options)) {
    configuration.unused.emplace_back(key);
  }
  return configuration;
}

NodeConfiguration readPrivateParameters() {
  // ros::param::get alone does not tell a node without parameters from a master that is gone.
  const std::string& node = ros::this_node::getName();
  XmlRpc::XmlRpcValue request, response, exist, parameters;
  request[0] = node;
  request[1] = node;
  const bool answered = ros::master::execute("hasParam", request, response, exist, false);
  if (!answered || (static_cast<bool>(exist) && !ros::param::get(node, parameters))) {
    throw FileError(
        fmt::format("{}: the ROS master at {} did not answer when the parameters were read", node,
                    ros::master::getURI()));
  }
  return readParameters(parameters, node);
}

}  // namespace spring_pendulum
