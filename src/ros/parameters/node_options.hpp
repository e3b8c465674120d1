// The ROS options besides the scenario: display, timing and publishing; and the parameters of the node.
#pragma once

#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/simulation/scenario.hpp>

#include <XmlRpcValue.h>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {

enum class AtEnd { kHold, kExit };

/// The initialisers are the defaults, and their only definition.
struct NodeOptions {
  std::string frame_id = "world";
  double real_time_factor = 1.0;  ///< simulated seconds per second; 0: as fast as possible
  double display_rate = 30.0;     ///< Hz, states shown per second; 0: frames only
  AtEnd at_end = AtEnd::kHold;
  std::int64_t wait_for_subscribers = 0;
  std::string wait_for_nodes;  ///< names of the only subscribers that count; empty: all count
  double wait_timeout = 30.0;  ///< s; 0: unlimited
  bool publish_clock = false;
  bool track_dissipation = true;       ///< integrate the dissipated power as well
  std::string color;                   ///< "#rrggbb"; empty: by strain and mass
  std::int64_t display_limit = 10000;  ///< largest number of drawn particles
  std::int64_t text_row = 0;           ///< line of text, counted upwards; 0: the only chain
  std::string held;                    ///< particles that robots hold: "1, last=gripper"
  std::string camera_frame = "pendulum_camera";  ///< empty: none

  /// Simulated time between two shown states, s; 0: only frames are shown.
  double displayInterval() const {
    const bool smooth = display_rate > 0.0 && real_time_factor > 0.0;
    return smooth ? real_time_factor / display_rate : 0.0;
  }
};

/// Display options, which the node and record_bag share. Bound to `options`.
std::vector<Option> displayOptions(NodeOptions& options);

/// Options of the node only. Bound to `options`.
std::vector<Option> playOptions(NodeOptions& options);

/// \throws InputError for options that contradict each other
void checkNodeOptions(const NodeOptions& options);

/// What the private parameters of the node say.
struct NodeConfiguration {
  NodeConfiguration() { scenario.output.clear(); }  ///< frames are written on request only

  Scenario scenario;
  NodeOptions options;
  std::string unused;  ///< given keys that the method does not use: "tolerance, frame_interval"
};

/// All parameters of the node, bound to `configuration`.
OptionSet nodeOptions(NodeConfiguration& configuration);

/// Returns the raw value as text: 4, "4" and 4.0 are the same, and so are true and "true".
/// \param place prefix of error messages: "/pendulum: frames"
/// \throws InputError for a list, a map or anything else that is not a single value
std::string parameterText(XmlRpc::XmlRpcValue& value, const std::string& place);

/// Reads the private parameters of this node.
/// \throws InputError for an unknown key, listing the known ones, or a wrong value; also for a number
///   or truth value where text is needed, because ROS guesses types
/// \throws FileError if the ROS master does not answer
NodeConfiguration readPrivateParameters();

}  // namespace spring_pendulum
