// Writes the messages of a run directly to a bag: without a master, as fast as possible, stamped
// with simulated time, and with the same bytes in every run.
#include "base/numbers.hpp"
#include "io/program/closing.hpp"
#include "io/program/command_line.hpp"
#include "io/program/exit_status.hpp"
#include "io/program/interruption.hpp"
#include "io/program/standard_streams.hpp"
#include "ros/bag_recorder.hpp"
#include "simulation/advice/stability_warning.hpp"
#include "simulation/integrator_settings.hpp"
#include "simulation/memory.hpp"
#include "simulation/options/scenario_options.hpp"
#include "simulation/tolerance.hpp"
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/simulation/stability_advice.hpp>

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

namespace spring_pendulum {
namespace {

/// Prints the output of --report-skips and --check.
void report(const Scenario& scenario, bool track_energy, const Switches& switches) {
  const Particles particles = readParticles(scenario);
  const Chain chain(particles.masses, scenario.spring(), scenario.gravity);
  checkTolerance(scenario, chain, particles.state);
  const auto integrator =
      makeIntegrator(scenario.method, chain, integratorOptions(scenario, track_energy));
  if (switches.report_skips) printOutput(skippedWork(scenario, *integrator, track_energy));
  if (switches.check) printOutput(describeStability(chain, particles.state, scenario));
}

int record(int argc, const char* const* argv) {
  const auto start = std::chrono::steady_clock::now();
  const ProgramText program{"record_bag",
                            "Writes the messages that pendulum_node publishes straight into a bag.",
                            "Runge-Kutta-4 --particles particle.txt --bag pendulum.bag"};
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
  if (switches.check || switches.report_skips) {
    report(scenario, display.track_energy || !scenario.energy.empty(), switches);
  }
  if (switches.check) return kDone;
  bag.config = switches.config;
  catchInterruptions();
  PendulumRun run(scenario, readParticles(scenario),
                  display.track_energy || !scenario.energy.empty(),
                  display.display_rate > 0.0 ? 1.0 / display.display_rate : 0.0);
  const std::string warning = stabilityWarning(run.chain(), scenario);
  const BagSummary summary = recordBag(run, display, bag, [&] {
    printRemark(memoryRemark(scenario, run.chain().size()));
    printRemark(remarkOn(scenario));
    printWarning(warning);
  });
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  printClosingLine(fmt::format(
      "{}: {}, {}, {} bytes in {}, {}, {}, verdict: {}", scenario.method.get().name,
      counted(summary.frames, "frame"), counted(summary.messages, "message"), summary.bytes,
      summary.path, durationText(time.count()), run.measurements(), toString(run.verdict().kind)));
  return conclude(scenario, run.chain(), run.start(), run.verdict(), run.toleranceRemark());
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
