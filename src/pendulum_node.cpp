// The ROS node: integrates the motion of a chain, writes its frames and shows it.
#include "io/program/command_line.hpp"
#include "io/program/exit_status.hpp"
#include "io/program/interruption.hpp"
#include "io/program/standard_streams.hpp"
#include "ros/node/node.hpp"
#include "ros/node/startup.hpp"
#include "ros/parameters/parameters.hpp"
#include <spring_pendulum/model/equilibrium.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <ros/ros.h>

#include <cstdio>
#include <exception>
#include <optional>
#include <string>

namespace spring_pendulum {
namespace {

/// A chain that starts at rest hangs between its holders, not from P_1 alone.
void startAtRest(NodeConfiguration& configuration, Particles& particles) {
  Scenario& scenario = configuration.scenario;
  const std::string& held = configuration.options.held;
  if (scenario.start != Start::kAtRest || held.empty() || particles.frame != 0) return;
  Drive drive;
  for (const std::ptrdiff_t i : parseParticleList(held, particles.masses.size(), "held")) {
    drive.held.push_back({i, {}});
  }
  const Chain chain = scenario.chainOf(particles.masses);
  particles.state = equilibrium(chain.drivenBy(drive), particles.state);
  scenario.start = Start::kFile;
}

int runNode() {
  NodeConfiguration configuration = readPrivateParameters();
  Particles particles = readParticles(configuration.scenario, "_particles:=FILE");
  startAtRest(configuration, particles);
  if (!configuration.unused.empty()) {
    ROS_INFO_STREAM(configuration.scenario.method.get().name
                    << " does not use "
                    << fmt::format("{}", fmt::join(configuration.unused, ", ")));
  }
  ros::NodeHandle node, private_node("~");
  Node pendulum(node, private_node, configuration, particles);
  pendulum.spin();
  return pendulum.run().verdict().kind == VerdictKind::kDiverged ? kDiverged : kDone;
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  using namespace spring_pendulum;
  prepareProcess();
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // line buffered, also in a file
  try {
    const std::string answer = startRos(argc, argv);
    if (!answer.empty()) {
      printOutput(answer);
      flushOutput();
      return kDone;
    }
  } catch (const std::exception& error) {
    const Failure failure = failureOf(error);
    printError(failure.message + "\n");
    return failure.status;
  }
  // Without a master, ROS waits until it is shut down.
  catchInterruptions(ros::requestShutdown);
  std::optional<ros::NodeHandle> keeps_ros_started;
  try {
    keeps_ros_started.emplace();
    if (interruption() != 0) return kDone;
    return runNode();
  } catch (const std::exception& error) {
    const Failure failure = failureOf(error);
    logFatal(failure.message);
    return failure.status;
  }
}
