// Writes the messages of a run directly to a bag: without a master, as fast as possible, stamped
// with simulated time, and with the same bytes in every run.
#include "io/program/closing.hpp"
#include "io/program/command_line.hpp"
#include "io/program/exit_status.hpp"
#include "io/program/interruption.hpp"
#include "io/program/standard_streams.hpp"
#include "ros/bag_recorder.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/simulation/run.hpp>

#include <console_bridge/console.h>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <optional>
#include <string>

namespace spring_pendulum {
namespace {

int record(int argc, const char* const* argv) {
  ProgramText program{"record_bag",
                      "Writes the messages that pendulum_node publishes straight into a bag.",
                      "Runge-Kutta-4 particle.txt --bag pendulum.bag"};
  program.method_from = "inputs";
  Scenario scenario;
  scenario.output.clear();  // frame files only with --output
  NodeOptions display;
  BagOptions bag;
  OptionSet options(bagOptions(bag));
  options.add(displayOptions(display));
  options.add(scenarioOptions(scenario));
  const Switches switches = parseCommandLine(argc, argv, program, options, scenario);
  if (!switches.answer.empty()) {
    printOutput(switches.answer);
    return kDone;
  }
  if (!options.isGiven("output")) scenario.no_frames = true;
  bag.config = switches.config;
  console_bridge::noOutputHandler();  // rosbag also throws what it prints of a damaged bag
  std::optional<Replay> replay;
  if (!bag.inputs.empty()) replay.emplace(bag.inputs);
  double display_interval = display.display_rate > 0.0 ? 1.0 / display.display_rate : 0.0;
  if (replay) display_interval = replay->displayInterval();
  const Particles particles = replay ? replay->begin(scenario) : readParticles(scenario);
  Run run(scenario, particles,
          {display.track_dissipation || !scenario.energy.empty(), display_interval, interruption});
  if (switches.has("check")) return printAdvice(run);
  catchInterruptions();
  const std::string remarks = remarksOn(run) + warningLine(replay ? replay->missing() : "");
  const std::string output =
      recordBag(run, replay ? &*replay : nullptr, display, bag, [&] { printError(remarks); });
  printClosingLine(run.closingLine(output));
  if (replay && interruption() == 0) printError(warningLine(replay->unreached()));
  return conclude(run);
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  using namespace spring_pendulum;
  prepareProcess();
  try {
    const int status = record(argc, argv);
    flushOutput();
    return status;
  } catch (const std::exception& error) {
    const Failure failure = failureOf(error);
    printError(failure.message + "\n");
    std::fflush(stdout);
    // A bag that could not be written can't be closed either (see recordBag). At a regular exit,
    // the plugin loader of rosbag in Debian 13 would warn about objects that still exist.
    std::_Exit(failure.status);
  }
}
