// The ROS node: integrates the motion of a chain, writes its frames and shows it.
#include "io/program/command_line.hpp"
#include "io/program/exit_status.hpp"
#include "io/program/interruption.hpp"
#include "io/program/standard_streams.hpp"
#include "ros/node/live_run.hpp"
#include "ros/node/player.hpp"
#include "ros/node/publisher.hpp"
#include "ros/node/run_log.hpp"
#include "ros/node/startup.hpp"
#include "ros/parameters/parameters.hpp"

#include <fmt/format.h>

#include <ros/ros.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <string>

namespace spring_pendulum {
namespace {

constexpr double kLastMessages = 0.5;  // s, for sending the last messages
constexpr double kLastDeletion = 0.1;  // s, for sending the deletion of the markers

/// The frame loop: advances the run, writes the frame, and publishes the state.
void play(Run& run, LiveRun& live, Player& player, Publisher& publisher, RunFiles& files,
          RunLog& log) {
  live.start();
  for (Player::Action action = Player::Action::kShowAgain; action != Player::Action::kQuit;
       action = player.next()) {
    publisher.holdCamera(live.isGrabbed());  // it must not move under the mouse
    live.act(action, publisher);
    if (run.wasStopped()) return;  // inside a frame, which is discarded
    files.write(run);
    if (run.isOver()) files.finish();
    if (const auto header = publisher.publish(run, player.showing())) live.show(*header);
    log.note();
  }
}

int runNode() {
  const NodeConfiguration configuration = readPrivateParameters();
  const Scenario& scenario = configuration.scenario;
  const NodeOptions& options = configuration.options;
  Run run(scenario, readParticles(scenario, "_particles:=FILE"),
          {options.track_dissipation || !scenario.energy.empty(), options.displayInterval(),
           interruption});
  std::unique_ptr<Integrator> integrator = run.makeIntegrator();
  if (!configuration.unused.empty()) {
    ROS_INFO_STREAM(scenario.method.get().name
                    << " does not use "
                    << fmt::format("{}", fmt::join(configuration.unused, ", ")));
  }

  ros::NodeHandle node, private_node("~");
  Publisher publisher(node, run, options);
  Player player(node, private_node, run, options);
  LiveRun live(node, private_node, run, integrator, options, player);
  RunFiles files(run);  // last, because it removes the frames of earlier runs
  logStart(run, options, files);
  ROS_INFO_STREAM("parameters: " << configuration.values);
  publisher.waitForSubscribers(options);
  catchInterruptions();  // from now on ROS continues after a signal until the files are closed
  RunLog log(run, integrator, files, publisher, options.at_end == AtEnd::kHold);
  play(run, live, player, publisher, files, log);
  live.end();
  files.finish();
  log.finish();

  if (interruption() == 0 && ros::ok()) ros::WallDuration(kLastMessages).sleep();
  publisher.clear();
  if (ros::ok()) ros::WallDuration(kLastDeletion).sleep();
  return run.verdict().kind == VerdictKind::kDiverged ? kDiverged : kDone;
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
