// The ROS node: integrates the motion of a chain, writes its frames and shows it.
#include "io/program/command_line.hpp"
#include "io/program/program.hpp"
#include "ros/node/node.hpp"
#include "ros/parameters/parameters.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/run_files.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <boost/filesystem.hpp>  // before Boost 1.72, exception.hpp lacks filesystem_error
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <ros/network.h>
#include <ros/ros.h>

#include <clocale>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

namespace spring_pendulum {
namespace {

/// roscpp aborts at an address of the ROS master that it cannot parse.
void checkMasterUri(int argc, char** argv) {
  const char* const variable = std::getenv("ROS_MASTER_URI");
  std::string source = "ROS_MASTER_URI";
  std::string uri = variable != nullptr ? variable : "http://localhost:11311";
  const std::string argument = "__master:=";
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i];
    if (text.compare(0, argument.size(), argument) != 0) continue;
    source = "__master";
    uri = text.substr(argument.size());
  }
  std::string host;
  std::uint32_t port = 0;
  if (ros::network::splitURI(uri, host, port) && !host.empty() && port > 0 && port < 65536) return;
  throw InputError(fmt::format("{}: must be http://HOST:PORT, got '{}'", source, uri));
}

/// To ROS, `method:=Auto` without the underscore renames a topic, which has no effect.
void refuseForgottenUnderscore(int argc, char** argv, const OptionSet& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i];
    for (const Option& option : options.options()) {
      if (text.rfind(std::string(option.key) + ":=", 0) != 0) continue;
      throw InputError(fmt::format("'{}' sets no parameter: write _{}", text, text));
    }
  }
}

std::string helpText(const OptionSet& options) {
  std::string text =
      "Simulates a chain of springs, writes its frames and publishes them for rviz.\n\n"
      "Usage: rosrun spring_pendulum pendulum_node [_PARAMETER:=VALUE ...]\n"
      "Example: rosrun spring_pendulum pendulum_node _method:=Auto _particles:=particle.txt\n\n"
      "Parameters, with their defaults in brackets:\n";
  for (const Option& option : options.options()) {
    const std::string value = option.isFlag() ? "true|false" : option.placeholder();
    text += fmt::format("  _{}:={}\n      {}\n", option.key, value, optionHelp(option));
  }
  return text +
         "\nExit status: 0 done or interrupted, 1 could not read or write, 2 bad input,\n"
         "3 the motion diverged.\n";
}

/// Checks the arguments and initialises ROS, which takes the arguments with ":=" away. From then on
/// SIGINT ends the program even if it was ignored, as in a job that a script starts with `&`, and
/// the log keeps UTF-8.
/// \returns the text to print instead of a run: --help; else empty
/// \throws InputError for wrong arguments, FileError if ROS cannot create its log folder
std::string startRos(int argc, char** argv) {
  NodeConfiguration defaults;
  const OptionSet options = nodeOptions(defaults);
  if (argc > 1 && (argv[1] == std::string("--help") || argv[1] == std::string("-h"))) {
    return helpText(options);
  }
  checkMasterUri(argc, argv);
  refuseForgottenUnderscore(argc, argv, options);
  std::signal(SIGINT, [](int /*signal*/) { std::_Exit(kDone); });  // ROS may wait for its master
  std::setlocale(LC_CTYPE, "C.UTF-8");  // log4cxx prints '?' for what the locale lacks
  try {
    // The handler of roscpp would end ROS before the files are closed and the closing line is logged.
    ros::init(argc, argv, "pendulum_node", ros::init_options::NoSigintHandler);
  } catch (const ros::InvalidNameException& error) {
    throw InputError(error.what());
  } catch (const boost::filesystem::filesystem_error& error) {
    throw FileError(fmt::format(
        "{}: the log folder of ROS could not be created: {}; set ROS_HOME to a writable folder",
        error.path1().string(), error.code().message()));
  }
  if (ros::this_node::getName() == "/") throw InputError("the name of the node must not be empty");
  if (argc > 1) {
    throw InputError(fmt::format(
        "unexpected argument '{}': the node takes parameters, for example _frames:=100", argv[1]));
  }
  return "";
}

/// A chain that starts at rest hangs between its holders, not from P_1 alone.
Scene readNodeScene(const NodeConfiguration& configuration) {
  Scenario scenario = configuration.scenario;
  const std::string& held = configuration.options.held;
  const bool hangs = scenario.start == Start::kAtRest && !held.empty();
  if (hangs) scenario.start = Start::kFile;
  Scene scene = readScene(scenario, "_particles:=FILE");
  if (!hangs) return scene;
  Drive drive;
  for (const std::ptrdiff_t i : parseParticleList(held, scene.masses.size(), "held")) {
    drive.held.push_back({i, {}});
  }
  scene.state = equilibrium(scene.chain().drivenBy(drive), scene.state);
  return scene;
}

int runNode() {
  const NodeConfiguration configuration = readPrivateParameters();
  const Scene scene = readNodeScene(configuration);
  if (!configuration.unused.empty()) {
    ROS_INFO_STREAM(configuration.scenario.method.get().name
                    << " does not use "
                    << fmt::format("{}", fmt::join(configuration.unused, ", ")));
  }
  ros::NodeHandle node, private_node("~");
  Node pendulum(node, private_node, configuration, scene);
  pendulum.spin();
  return pendulum.run().verdict().kind == VerdictKind::kDiverged ? kDiverged : kDone;
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  using namespace spring_pendulum;
  std::optional<ros::NodeHandle> keeps_ros_started;
  const auto run = [&] {
    std::setvbuf(stdout, nullptr, _IOLBF, 0);  // line buffered, also in a file
    const std::string answer = startRos(argc, argv);
    printOutput(answer);
    if (!answer.empty()) return static_cast<int>(kDone);
    // Without a master, ROS waits until it is shut down.
    catchInterruptions(ros::requestShutdown);
    keeps_ros_started.emplace();
    return interruption() == 0 ? runNode() : kDone;
  };
  return runProgram(run, [&](const std::string& message) {
    keeps_ros_started ? logFatal(message) : printError(message + "\n");
  });
}
