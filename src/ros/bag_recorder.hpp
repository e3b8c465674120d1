// Records the messages of a run in a bag without a running ROS master.
#pragma once

#include "ros/inputs/input_messages.hpp"
#include "ros/parameters/node_options.hpp"
#include <spring_pendulum/simulation/run.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace spring_pendulum {

struct BagOptions {
  std::string path = "pendulum.bag";
  std::string name_space;  ///< prefix of the topics
  std::string inputs;      ///< bag whose run is repeated; empty: none
  bool append = false;     ///< add to the bag instead of replacing it
  std::string config;      ///< configuration file of the run, which must not be overwritten
};

/// Returns the options of record_bag, bound to `options`.
std::vector<Option> bagOptions(BagOptions& options);

/// Records a run. Stamps are simulated time, starting at `Stamps::simulatedStart()`. The same
/// scenario and options give the same bytes. The bag is complete or absent, like every OutputFile;
/// when appending, a longer copy replaces the bag at the end. After a signal, the bag ends with the
/// last message before it.
/// \param started called when nothing about the files can be refused any more, before the run
/// \returns for the closing line: ", 501 messages, 123456 bytes in /home/me/pendulum.bag"
/// \throws FileError naming the bag
std::string recordBag(
    Run& run, Replay* replay, const NodeOptions& options, const BagOptions& to,
    const std::function<void()>& started = [] {});

}  // namespace spring_pendulum
