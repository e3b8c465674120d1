#include "ros/parameters/parameters.hpp"

#include "base/numbers.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <ros/master.h>
#include <ros/names.h>
#include <ros/param.h>
#include <ros/this_node.h>

#include <cmath>
#include <optional>
#include <regex>

namespace spring_pendulum {
namespace {

/// ROS reads 0042 as the number 42: such a value is not the text that was written.
void refuseGuess(XmlRpc::XmlRpcValue& value, const std::string& text, const Option& option,
                 const std::string& place) {
  const bool is_text = value.getType() == XmlRpc::XmlRpcValue::TypeString;
  if (is_text || !std::holds_alternative<Text>(option.value)) return;
  throw InputError(fmt::format(
      "{}: must be text, but ROS has read it as the {} {}; write _{}:=./NAME for a file, "
      "type=\"str\" in a launch file, or quotes in YAML",
      place, value.getType() == XmlRpc::XmlRpcValue::TypeBoolean ? "truth value" : "number", text,
      option.key));
}

/// Reads the tf frame of a holder, `held_<i>_frame`.
/// \returns whether the key is of this kind
bool takeHeldFrame(const std::string& key, XmlRpc::XmlRpcValue& value, const std::string& place,
                   NodeOptions& options) {
  std::smatch match;
  if (!std::regex_match(key, match, std::regex("held_(.+)_frame"))) return false;
  const std::optional<double> particle = parseNumber(match[1].str());
  if (!particle || *particle < 1.0 || *particle > 1e15 || *particle != std::floor(*particle)) {
    throw InputError(place + ": write the number of a held particle: held_1_frame");
  }
  const std::string frame = parameterText(value, place);
  if (frame.empty() || frame.front() == '/') {
    throw InputError(place + ": must be a name without a leading '/'");
  }
  options.held_frames[static_cast<std::int64_t>(*particle)] = frame;
  return true;
}

/// Joins a list of numbers and words to one text.
void joinList(XmlRpc::XmlRpcValue& value) {
  if (value.getType() != XmlRpc::XmlRpcValue::TypeArray) {
    if (value.getType() == XmlRpc::XmlRpcValue::TypeInt) value = parameterText(value, "");
    return;
  }
  std::string text;
  // NOLINTNEXTLINE(modernize-loop-convert): begin() is for members of a struct
  for (int i = 0; i < value.size(); ++i) {
    text += (text.empty() ? "" : ", ") + parameterText(value[i], "a list of particles");
  }
  value = text;
}

}  // namespace

OptionSet nodeOptions(NodeConfiguration& configuration) {
  OptionSet options(scenarioOptions(configuration.scenario));
  options.add(displayOptions(configuration.options));
  options.add(playOptions(configuration.options));
  return options;
}

std::string parameterText(XmlRpc::XmlRpcValue& value, const std::string& place) {
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
      throw InputError(
          fmt::format("{}: must be a single value, got a list, a map or binary data", place));
  }
}

NodeConfiguration readParameters(XmlRpc::XmlRpcValue& parameters, const std::string& where) {
  NodeConfiguration configuration;
  OptionSet options = nodeOptions(configuration);
  if (parameters.getType() == XmlRpc::XmlRpcValue::TypeStruct) {
    for (auto& [key, value] : parameters) {
      const std::string place = fmt::format("{}: {}", where, key);
      if (takeHeldFrame(key, value, place, configuration.options)) continue;
      if (key == "held" || key == "tf_particles") joinList(value);
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
  const std::string own = ros::names::resolve("state"), &follow = configuration.options.follow;
  if (!follow.empty() && ros::names::resolve(follow) == own) {  // it would wait for ever
    throw InputError(fmt::format(
        "{}: follow: {} is the topic of this node; give the state topic of another node", where,
        own));
  }
  for (const std::string_view key : unusedKeys(configuration.scenario, options)) {
    configuration.unused.emplace_back(key);
  }
  const bool fixed_step = configuration.scenario.method.get().hasFixedStep();
  for (const Option& option : options.options()) {
    if (option.applies_to == (fixed_step ? AppliesTo::kErrorControlled : AppliesTo::kFixedStep))
      continue;
    const std::string text = option.text();
    if (text.empty()) continue;
    const bool is_word = text.find_first_of(" #'\"\\$&;|<>()*?`!~") == std::string::npos;
    configuration.values += fmt::format(is_word ? "_{}:={} " : "_{}:='{}' ", option.key, text);
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
  try {
    return readParameters(parameters, node);
  } catch (const InputError& error) {  // parameters of an earlier run stay on the ROS master
    throw InputError(
        fmt::format("{}. If an earlier run has left this parameter, delete it: rosparam delete {}",
                    error.what(), node));
  }
}

}  // namespace spring_pendulum
