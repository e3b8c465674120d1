// Reads the private parameters of the node into the option tables.
#pragma once

#include "ros/parameters/node_options.hpp"
#include "simulation/options/option_set.hpp"
#include <spring_pendulum/simulation/scenario.hpp>

#include <XmlRpcValue.h>
#include <string>
#include <vector>

namespace spring_pendulum {

struct NodeConfiguration {
  NodeConfiguration() {
    scenario.output.clear();
  }  // a node that shows writes frames on request only

  Scenario scenario;
  NodeOptions options;
  std::vector<std::string> unused;  ///< given keys that the method does not use
  std::string values;               ///< all parameters in effect: "_method:=Euler _frames:=500 ..."
};

/// All parameters of the node, bound to `configuration`.
OptionSet nodeOptions(NodeConfiguration& configuration);

/// Returns the raw value as text: 4, "4" and 4.0 are the same, and so are true and "true".
/// \param place prefix of error messages: "/pendulum: frames"
/// \throws InputError for a list, a map or anything else that is not a single value
std::string parameterText(XmlRpc::XmlRpcValue& value, const std::string& place);

/// \param parameters a map from key to value
/// \param where      prefix of error messages: the name of the node
/// \throws InputError for an unknown key, listing the known ones, or a wrong value; also for a
///   number or truth value where text is needed, because ROS guesses types
NodeConfiguration readParameters(XmlRpc::XmlRpcValue& parameters, const std::string& where);

/// Reads the private parameters of this node.
/// \throws InputError as readParameters, FileError if the ROS master does not answer
NodeConfiguration readPrivateParameters();

}  // namespace spring_pendulum
