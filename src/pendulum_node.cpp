// The ROS node: integrates the motion of a chain, writes its frames and shows it.
#include "io/program/command_line.hpp"
#include "io/program/program.hpp"
#include "ros/messages/run_messages.hpp"
#include "ros/node/node.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/run_files.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <boost/filesystem.hpp>  // before Boost 1.72, exception.hpp lacks filesystem_error
#include <fmt/format.h>

#include <ros/network.h>
#include <ros/ros.h>
#include <ros/xmlrpc_manager.h>

#include <clocale>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

namespace spring_pendulum {
namespace {

/// Refuses what ROS would misunderstand: an address of the master that it cannot parse, at which it
/// aborts, and `method:=Auto` without the underscore, which renames a topic.
void checkArguments(const std::vector<std::string>& arguments, const OptionSet& options) {
  const char* const variable = std::getenv("ROS_MASTER_URI");
  std::string source = "ROS_MASTER_URI";
  std::string uri = variable != nullptr ? variable : "http://localhost:11311";
  for (const std::string& text : arguments) {
    const std::string name = text.substr(0, text.find(":="));
    if (name == text) continue;
    for (const Option& option : options.options())
      if (option.key == name)
        throw InputError(fmt::format("'{}' sets no parameter: write _{}", text, text));
    if (name != "__master") continue;
    source = name;
    uri = text.substr(name.size() + 2);
  }
  std::string host;
  std::uint32_t port = 0;
  if (ros::network::splitURI(uri, host, port) && !host.empty() && port > 0 && port < 65536) return;
  throw InputError(fmt::format("{}: must be http://HOST:PORT, got '{}'", source, uri));
}

std::string helpText(const OptionSet& options) {
  std::string text =
      "Simulates a chain of springs and publishes it for rviz.\n\n"
      "Usage: rosrun spring_pendulum pendulum_node [_PARAMETER:=VALUE ...]\n\n"
      "Parameters, with their defaults in brackets:\n";
  for (const Option& option : options.options())
    text += fmt::format("  _{}\n      {}\n", option.key, optionHelp(option));
  return text;
}

/// Ends a program that a signal stops while it starts. Only this ends the wait of ROS for its master.
void stopStarting() {
  if (!ros::isStarted()) std::_Exit(kDone);
  ros::requestShutdown();
}

/// Ends the run when the master asks for it. ROS itself would shut down before the files are closed, and
/// abort while topics are advertised. Must be called before ROS starts: the first handler stays.
void endWhenTheMasterAsks() {
  using XmlRpc::XmlRpcValue;
  const auto end = [asked = false](XmlRpcValue& call, XmlRpcValue& answer) mutable {
    answer = ros::xmlrpc::responseInt(1, "", 0);
    if (std::exchange(asked, true)) return;
    ::kill(::getpid(), SIGINT);  // this thread of ROS takes no signals
    ROS_WARN_STREAM("the master ends this node: " << static_cast<std::string>(call[1]));
  };
  ros::XMLRPCManager::instance()->bind("shutdown", end);
}

/// Checks the arguments and initialises ROS, which takes those with ":=" away. From then on SIGINT ends the
/// program even if it was ignored, as in a job that a script starts with `&`, and the log keeps UTF-8.
/// \returns the text to print instead of a run: --help; else empty
/// \throws InputError for wrong arguments, FileError if ROS cannot create its log folder
std::string startRos(int argc, char** argv) {
  NodeConfiguration defaults;
  const OptionSet options = nodeOptions(defaults);
  if (argc > 1 && (argv[1] == std::string("--help") || argv[1] == std::string("-h")))
    return helpText(options);
  checkArguments({argv + 1, argv + argc}, options);
  std::signal(SIGINT, SIG_DFL);
  catchInterruptions(stopStarting);
  std::setlocale(LC_CTYPE, "C.UTF-8");  // log4cxx prints '?' for what the locale lacks
  try {
    // The handler of roscpp would end ROS before the files are closed and the closing line is logged.
    ros::init(argc, argv, "pendulum_node", ros::init_options::NoSigintHandler);
  } catch (const ros::Exception& error) {
    throw InputError(error.what());
  } catch (const boost::filesystem::filesystem_error& error) {
    throw FileError(fmt::format(
        "{}: the log folder of ROS could not be created: {}; set ROS_HOME to a writable folder",
        error.path1().string(), error.code().message()));
  }
  if (ros::this_node::getName() == "/") throw InputError("the name of the node must not be empty");
  if (argc > 1)
    throw InputError(fmt::format(
        "unexpected argument '{}': the node takes parameters, for example _frames:=100", argv[1]));
  return "";
}

/// A chain that starts at rest hangs between its holders, not from P_1 alone.
Scene readNodeScene(const NodeConfiguration& configuration) {
  Scenario scenario = configuration.scenario;
  const std::string& held = configuration.options.held;
  const bool hangs = scenario.start == Start::kAtRest && !held.empty();
  if (hangs) scenario.start = Start::kFile;
  Scene scene = readScene(scenario, "_particles:=FILE");
  Drive drive;
  for (const auto& [i, frame] : parseHeld(held, scene.masses.size())) drive.held.push_back({i, {}});
  if (hangs) scene.state = equilibrium(scene.chain().drivenBy(drive), scene.state);
  return scene;
}

int runNode(std::optional<ros::NodeHandle>& keeps_ros_started) {
  const NodeConfiguration configuration = readPrivateParameters();
  const auto& [scenario, options, unused] = configuration;
  const Scene scene = readNodeScene(configuration);
  catchInterruptions(ros::requestShutdown);  // while files are open, the program must not exit
  const bool track_dissipation = options.track_dissipation || !scenario.energy.empty();
  Run run(scene, scenario, {track_dissipation, options.displayInterval(), interruption});
  const RunMessages probe(run, options, options.publish_clock);  // refuses times beyond stamps
  if (interruption() != 0) return kDone;
  RunFiles files(run, scenario);
  // Whatever may be refused has been: this ends an earlier node of the same name.
  if (interruption() == 0) keeps_ros_started.emplace();
  catchInterruptions();  // only recorded from now on: ROS continues until the files are closed
  if (interruption() != 0 || !ros::ok()) return kDone;
  if (!unused.empty()) ROS_INFO_STREAM(scenario.method.get().name << " does not use " << unused);
  return Node(scenario, options, run, files).spin();
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  using namespace spring_pendulum;
  std::optional<ros::NodeHandle> keeps_ros_started;
  bool are_arguments_right = false;
  const auto run = [&] {
    std::setvbuf(stdout, nullptr, _IOLBF, 0);  // line buffered, also in a file
    const std::string answer = startRos(argc, argv);
    printOutput(answer);
    if (!answer.empty()) return static_cast<int>(kDone);
    are_arguments_right = true;
    endWhenTheMasterAsks();
    return runNode(keeps_ros_started);
  };
  return runProgram(run, [&](const std::string& message) {
    if (!are_arguments_right) return printError(message + "\n");
    ROS_FATAL_STREAM(message);
  });
}
