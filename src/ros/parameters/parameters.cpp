// Reads the private parameters of the node into the option tables.
#include "base/numbers.hpp"
#include "ros/parameters/node_options.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <ros/master.h>
#include <ros/names.h>
#include <ros/param.h>
#include <ros/this_node.h>

namespace spring_pendulum {
namespace {

using XmlRpc::XmlRpcValue;

/// ROS reads 0042 as the number 42: such a value is not the text that was written.
void refuseGuess(XmlRpcValue& value, const std::string& text, const Option& option,
                 const std::string& place) {
  const bool is_text = value.getType() == XmlRpcValue::TypeString;
  // A particle is a number.
  if (is_text || !std::holds_alternative<Text>(option.value) || option.key == "held") return;
  throw InputError(fmt::format(
      "{}: must be text, but ROS has read it as the {} {}; write _{}:=./NAME for a file, "
      "type=\"str\" in a launch file, or quotes in YAML",
      place, value.getType() == XmlRpcValue::TypeBoolean ? "truth value" : "number", text,
      option.key));
}

/// \param parameters a map from key to value
/// \param where      prefix of error messages: the name of the node
NodeConfiguration readParameters(XmlRpcValue& parameters, const std::string& where) {
  NodeConfiguration configuration;
  OptionSet options = nodeOptions(configuration);
  if (parameters.getType() == XmlRpcValue::TypeStruct) {
    for (auto& [key, value] : parameters) {
      const std::string place = fmt::format("{}: {}", where, key);
      const Option& option = options.find(key, where);
      const std::string text = parameterText(value, place);
      refuseGuess(value, text, option, place);
      if (key == "output" && text.empty()) {  // a launch file can't omit a parameter
        options.set(options.find("no_frames", where), "true", place);
      } else {
        options.set(option, text, place);
      }
    }
  }
  checkScenario(configuration.scenario);
  checkNodeOptions(configuration.options);
  configuration.unused =
      fmt::format("{}", fmt::join(unusedKeys(configuration.scenario, options), ", "));
  return configuration;
}

}  // namespace

OptionSet nodeOptions(NodeConfiguration& configuration) {
  OptionSet options(scenarioOptions(configuration.scenario));
  options.add(displayOptions(configuration.options));
  options.add(playOptions(configuration.options));
  return options;
}

std::string parameterText(XmlRpcValue& value, const std::string& place) {
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
      throw InputError(
          fmt::format("{}: must be a single value, got a list, a map or binary data", place));
  }
}

NodeConfiguration readPrivateParameters() {
  // ros::param::get alone does not tell a node without parameters from a master that is gone.
  const std::string& node = ros::this_node::getName();
  XmlRpcValue request, response, exist, parameters;
  request[0] = node;
  request[1] = node;
  const bool answered = ros::master::execute("hasParam", request, response, exist, false);
  if (!answered || (static_cast<bool>(exist) && !ros::param::get(node, parameters))) {
    throw FileError(
        fmt::format("{}: the ROS master at {} did not answer when the parameters were read", node,
                    ros::master::getURI()));
  }
  try {
    return readParameters(parameters, node);
  } catch (const InputError& error) {  // parameters of an earlier run stay on the ROS master
    throw InputError(
        fmt::format("{}. If an earlier run has left this parameter, delete it: rosparam delete {}",
                    error.what(), node));
  }
}

}  // namespace spring_pendulum
