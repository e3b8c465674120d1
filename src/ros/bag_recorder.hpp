// A run as a bag of the messages that the node publishes, written without ROS running.
#pragma once

#include "ros/node_options.hpp"
#include <spring_pendulum/simulation/scenario.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace spring_pendulum {

struct BagOptions {
  std::string path = "pendulum.bag";
  std::string name_space;  ///< put before the topics
  bool append = false;     ///< add to the bag instead of replacing it
  std::string config;      ///< the YAML file that the run read, which must not be written
};

/// Bound to `options`.
std::vector<Option> bagOptions(BagOptions& options);

struct BagSummary {
  std::int64_t frames = 0;
  std::int64_t messages = 0;
  std::uintmax_t bytes = 0;  ///< of the file
  std::string path;          ///< absolute
  Verdict verdict;
  std::string measurements;  ///< position and energy error in words
};

/// Stamps are simulated time, starting at `Stamps::simulatedStart()`. The same scenario and options
/// give the same bytes. The bag is whole or absent, as every OutputFile; one that is appended to is
/// replaced by a longer copy at the end. A signal ends the run early, and the bag has what there is.
/// \throws InputError for a bad scenario, FileError naming the bag
BagSummary recordBag(const Scenario& scenario, const NodeOptions& options, const BagOptions& to);

}  // namespace spring_pendulum
