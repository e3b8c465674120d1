#include "ros/parameters/node_options.hpp"

#include "base/numbers.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <ros/master.h>
#include <ros/names.h>
#include <ros/param.h>
#include <ros/this_node.h>

#include <regex>

namespace spring_pendulum {
namespace {

bool isFrame(std::string_view text) {
  return text.find_first_of(" \t\n") == std::string_view::npos && text.substr(0, 1) != "/";
}

bool isColor(std::string_view text) {
  return std::regex_match(std::string(text), std::regex("|#[0-9a-fA-F]{6}"));
}

using XmlRpc::XmlRpcValue;

/// ROS reads 0042 as the number 42: such a value is not the text that was written.
void refuseGuess(XmlRpcValue& value, const std::string& text, const Option& option,
                 const std::string& place) {
  const bool is_text = value.getType() == XmlRpcValue::TypeString;
  // A particle is a number.
  if (is_text || !option.is<std::string>() || option.key == "held") return;
  throw InputError(fmt::format(
      "{}: must be text, but ROS has read it as the {} {}; write quotes in YAML, type=\"str\" in a "
      "launch file, or, for a file, _{}:=./NAME",
      place, value.getType() == XmlRpcValue::TypeBoolean ? "truth value" : "number", text,
      option.key));
}

void set(OptionSet& options, XmlRpcValue& parameters, const std::string& node) {
  for (auto& [key, value] : parameters) {
    const std::string place = fmt::format("{}: {}", node, key);
    const Option& option = options.find(key, node);
    const std::string text = parameterText(value, place);
    refuseGuess(value, text, option, place);
    if (key == "output" && text.empty())  // a launch file can't omit a parameter
      options.set(options.find("no_frames", node), "true", place);
    else
      options.set(option, text, place);
  }
}

}  // namespace

std::vector<Option> displayOptions(NodeOptions& o) {
  return {
      {"frame_id",
       Text{&o.frame_id, "NAME", "a name without blanks or a leading '/'",
            [](std::string_view text) { return !text.empty() && isFrame(text); }},
       "", "tf frame of all messages; the chain moves in its x-z plane"},
      {"display_rate", Number{&o.display_rate, Range::atLeast(0)}, "Hz",
       "states published per second on average, also between frames, at most one per fixed "
       "integration step; the frame files do not change; 0, or with `sleep`: frames only"},
      {"track_dissipation", Flag{&o.track_dissipation}, "",
       "always integrate the dissipated energy; false: only where it is cheap, as in Exercise3"},
      {"color",
       Text{&o.color, "#rrggbb", "#rrggbb, or empty for colours by strain and mass", isColor}, "",
       "one colour for the whole chain instead of colours by strain and mass"},
      {"display_limit", Count{&o.display_limit, Range::atLeast(2)}, "",
       "largest number of particles drawn; a longer chain is thinned, in the markers only"},
      {"text_row", Count{&o.text_row, Range::atLeast(0)}, "",
       "0: the only chain in the picture; else its line of text, counted upwards from 1: the first "
       "chain draws the grid and sets the camera, and the others are behind it and wider"},
      {"camera_frame",
       Text{&o.camera_frame, "NAME", "a name without blanks or a leading '/', or empty", isFrame},
       "", "tf frame of the camera that shows the whole scene; empty: none"},
  };
}

std::vector<Option> playOptions(NodeOptions& o) {
  return {
      {"real_time_factor", Number{&o.real_time_factor, Range::atLeast(0)}, "",
       "simulated seconds per second; 0: as fast as possible"},
      {"at_end", Choice(&o.at_end, {"hold", "exit"}), "", "what to do after the last frame"},
      {"wait_for_subscribers", Count{&o.wait_for_subscribers, Range::atLeast(0)}, "",
       "start when markers, state and status have this many subscribers in all"},
      {"wait_for_nodes",
       Text{&o.wait_for_nodes, "NAMES", "names separated by blanks, or empty", anyText}, "",
       "count subscribers with these names only, without namespaces; empty: all"},
      {"wait_timeout", Number{&o.wait_timeout, Range::atLeast(0)}, "s",
       "start without them after this time; 0: wait forever"},
      {"publish_clock", Flag{&o.publish_clock}, "",
       "publish simulated time on /clock and stamp with it"},
      {"held", Text{&o.held, "LIST", "particles such as '1, last=gripper', or empty", anyText}, "",
       "particles that follow held_<i>/odom or held_<i>/pose, or a tf frame such as gripper"},
  };
}

void checkNodeOptions(const NodeOptions& options) {
  if (options.camera_frame == options.frame_id)
    throw InputError(fmt::format("camera_frame: must not be frame_id, '{}'", options.frame_id));
}

OptionSet nodeOptions(NodeConfiguration& configuration) {
  OptionSet options(scenarioOptions(configuration.scenario));
  options.add(displayOptions(configuration.options));
  options.add(playOptions(configuration.options));
  return options;
}

std::string parameterText(XmlRpcValue& value, const std::string& place) {
  const XmlRpcValue::Type type = value.getType();
  if (type == XmlRpcValue::TypeBoolean) return static_cast<bool>(value) ? "true" : "false";
  if (type == XmlRpcValue::TypeInt) return fmt::format("{}", static_cast<int>(value));
  if (type == XmlRpcValue::TypeDouble) return numberText(static_cast<double>(value));
  if (type == XmlRpcValue::TypeString) return static_cast<std::string>(value);
  throw InputError(place + ": must be a single value, got a list, a map or binary data");
}

NodeConfiguration readPrivateParameters() {
  // ros::param::get alone does not tell a node without parameters from a master that is gone.
  const std::string& node = ros::this_node::getName();
  XmlRpcValue request, response, exist, parameters;
  request[0] = request[1] = node;
  // Waits for a master.
  const bool answered = ros::master::execute("hasParam", request, response, exist, true) &&
                        (!static_cast<bool>(exist) || ros::param::get(node, parameters));
  if (!answered)
    throw FileError(node + ": the ROS master at " + ros::master::getURI() +
                    " did not answer when the parameters were read");
  NodeConfiguration configuration;
  OptionSet options = nodeOptions(configuration);
  try {
    if (parameters.getType() == XmlRpcValue::TypeStruct) set(options, parameters, node);
    checkScenario(configuration.scenario);
    checkNodeOptions(configuration.options);
  } catch (const InputError& error) {  // parameters of an earlier run stay on the ROS master
    throw InputError(
        fmt::format("{}. If an earlier run has left this parameter, delete it: rosparam delete {}",
                    error.what(), node));
  }
  configuration.unused =
      fmt::format("{}", fmt::join(unusedKeys(configuration.scenario, options), ", "));
  return configuration;
}

}  // namespace spring_pendulum
