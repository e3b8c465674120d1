// The ROS node: carries a chain through time, writes its frames and shows it.
#include "io/failure.hpp"
#include "io/interruption.hpp"
#include "ros/parameters.hpp"
#include "ros/player.hpp"
#include "ros/publisher.hpp"
#include "ros/run_files.hpp"

#include <fmt/format.h>

#include <ros/ros.h>

#include <exception>
#include <filesystem>
#include <string>

namespace spring_pendulum {
namespace {

constexpr double kLastMessages = 0.5;  // s for the last messages to leave the node

/// What the closing line tells besides the run itself, which may have been reset.
struct Totals {
  std::int64_t frames = 0;
  std::int64_t steps = 0;
  double seconds = 0.0;  ///< integrating
};

/// The frame loop: advance, judge, hand the state to each output that is wanted.
Totals play(PendulumRun& run, Player& player, Publisher& publisher, RunFiles& files) {
  Totals totals{1, 0, 0.0};
  for (Player::Action action = Player::Action::kShowAgain; action != Player::Action::kQuit;
       action = player.next()) {
    if (action == Player::Action::kReset) run.reset();
    if (action == Player::Action::kAdvance || action == Player::Action::kAdvanceFrame) {
      const std::int64_t frame = run.frame(), steps = run.steps();
      const ros::WallTime start = ros::WallTime::now();
      run.advance(action == Player::Action::kAdvance && publisher.isWatched());
      totals.seconds += (ros::WallTime::now() - start).toSec();
      totals.frames += run.frame() - frame;
      totals.steps += run.steps() - steps;
    }
    files.write(run);
    publisher.publish(run, player.isPaused(), player.pace());
  }
  return totals;
}

std::string closingLine(const PendulumRun& run, const Totals& totals, const RunFiles& files,
                        const Publisher& publisher) {
  const EnergyEntry entry = run.energyEntry();
  const bool fixed_step = findMethod(run.scenario().method).control == StepControl::kFixed;
  return fmt::format(
      "{}: {} particles, {} frames, {}{} force evaluations, {:.3f} s integrating, {:.3f} s "
      "writing {} frames, {} marker and {} state messages built, energy error {}, verdict: {}",
      run.scenario().method, run.chain().size(), totals.frames,
      fixed_step ? fmt::format("{} steps, ", totals.steps) : "",
      run.integrator().forceEvaluations(), totals.seconds, files.seconds(), files.framesWritten(),
      publisher.markersBuilt(), publisher.statesBuilt(),
      entry.relative_residual ? fmt::format("{:.2e}", *entry.relative_residual) : "not tracked",
      run.verdict().text);
}

/// Simulated time between two states shown, s.
double displayInterval(const NodeOptions& options) {
  const bool smooth = options.display_rate > 0.0 && options.real_time_factor > 0.0;
  return smooth ? options.real_time_factor / options.display_rate : 0.0;
}

int runNode() {
  const NodeConfiguration configuration = readPrivateParameters();
  const Scenario& scenario = configuration.scenario;
  const NodeOptions& options = configuration.options;
  PendulumRun run(scenario, readParticleFile(scenario.particles),
                  options.track_energy || !scenario.energy.empty(), displayInterval(options));
  RunFiles files(scenario);
  ROS_INFO_STREAM(
      scenario.method << " on "
                      << std::filesystem::absolute(scenario.particles).lexically_normal().string()
                      << ", " << files.description());

  if (!configuration.unused.empty()) {
    ROS_INFO_STREAM(scenario.method << " does not use "
                                    << fmt::format("{}", fmt::join(configuration.unused, ", ")));
  }

  ros::NodeHandle node, private_node("~");
  Registration registration;
  Publisher publisher(node, run, options, registration);
  Player player(node, private_node, run, options, registration);
  registration.keep();
  publisher.waitForSubscribers(options);
  const Totals totals = play(run, player, publisher, files);
  files.finish();

  const bool diverged = run.verdict().kind == VerdictKind::kDiverged;
  ROS_LOG_STREAM(diverged ? ros::console::levels::Error : ros::console::levels::Info,
                 ROSCONSOLE_DEFAULT_NAME, closingLine(run, totals, files, publisher));
  if (interruption() == 0 && ros::ok()) ros::WallDuration(kLastMessages).sleep();
  return diverged ? kDiverged : kDone;
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  using namespace spring_pendulum;
  // roscpp's own handler would end ROS before the files are closed and the closing line is out.
  ros::init(argc, argv, "pendulum_node", ros::init_options::NoSigintHandler);
  catchInterruptions();
  ros::NodeHandle keeps_ros_started;
  try {
    return runNode();
  } catch (const std::exception& error) {
    const Failure failure = failureOf(error);
    ROS_FATAL_STREAM(failure.message);
    return failure.status;
  }
}
