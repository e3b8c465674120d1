// Records the messages of a run in a bag without a running ROS master.
#pragma once

#include "ros/parameters/node_options.hpp"
#include "ros/pendulum_run.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace spring_pendulum {

struct BagOptions {
  std::string path = "pendulum.bag";
  std::string name_space;  ///< prefix of the topics
  bool append = false;     ///< add to the bag instead of replacing it
  std::string config;      ///< configuration file of the run, which must not be overwritten
};

/// Returns the options of record_bag, bound to `options`.
std::vector<Option> bagOptions(BagOptions& options);

/// Numbers and texts for the closing line.
struct BagSummary {
  std::int64_t frames = 0;
  std::int64_t messages = 0;
  std::uintmax_t bytes = 0;  ///< size of the file
  std::string path;          ///< absolute
};

/// Records a run. Stamps are simulated time, starting at `Stamps::simulatedStart()`. The same
/// scenario and options give the same bytes. The bag is complete or absent, like every OutputFile;
/// when appending, a longer copy replaces the bag at the end. After a signal, the bag ends with the
/// last message before it.
/// \param started called when nothing about the files can be refused any more, before the run
/// \throws FileError naming the bag
BagSummary recordBag(
    PendulumRun& run, const NodeOptions& options, const BagOptions& to,
    const std::function<void()>& started = [] {});

}  // namespace spring_pendulum
