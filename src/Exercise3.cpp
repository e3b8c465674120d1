// The exercise: integrates the motion of a chain of particles and writes one file per frame.
#include "base/numbers.hpp"
#include "io/formats/run_files.hpp"
#include "io/program/closing.hpp"
#include "io/program/command_line.hpp"
#include "io/program/exit_status.hpp"
#include "io/program/interruption.hpp"
#include "io/program/progress.hpp"
#include "io/program/standard_streams.hpp"
#include "simulation/advice/stability_warning.hpp"
#include "simulation/integrator_settings.hpp"
#include "simulation/interruptible.hpp"
#include "simulation/memory.hpp"
#include "simulation/options/scenario_options.hpp"
#include "simulation/run_monitor.hpp"
#include "simulation/sleep.hpp"
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/simulation/frame_steps.hpp>
#include <spring_pendulum/simulation/stability_advice.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>

namespace spring_pendulum {
namespace {

/// Numbers for the closing line.
struct Summary {
  std::int64_t frames = 0;
  double seconds = 0.0;
};

/// The simulation loop: advances the state, judges it, and writes the frame.
Summary simulate(const Scenario& scenario, State& state, Integrator& integrator,
                 RunMonitor& monitor, RunFiles& files) {
  const auto start = std::chrono::steady_clock::now();
  const FrameSteps step = frameSteps(scenario);
  Progress progress(scenario.frames);
  Summary summary;
  try {
    while (summary.frames < scenario.frames && interruption() == 0) {
      if (summary.frames > 0) {
        integrator.advance(state, step.time_step, step.steps);
        monitor.follow(step.time_step, step.steps);
      }
      monitor.judge(step.timeOfFrame(summary.frames), state, integrator);
      if (!monitor.isShown()) break;
      files.write(summary.frames, state, monitor.energyEntry(), monitor.positionError().now);
      progress.show(++summary.frames);
    }
  } catch (const Interrupted&) {  // inside a frame, which is discarded
  }
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return summary;
}

void printSummary(const Scenario& scenario, const Summary& summary, const Chain& chain,
                  const SleepingIntegrator& integrator, const RunFiles& files,
                  const RunMonitor& monitor) {
  const std::int64_t slept = integrator.sleptCalls();
  const std::int64_t steps =
      std::max<std::int64_t>(summary.frames - 1 - slept, 0) * scenario.steps_per_frame;
  const std::string report = integrator.report();
  printClosingLine(fmt::format(
      "{}{}: {}, {}{}, {}{}, {} integrating{}, {} reference run, {}, verdict: {}",
      scenario.method.get().name, report.empty() ? "" : " (" + report + ")",
      counted(chain.size(), "particle"), counted(summary.frames, "frame"),
      slept > 0 ? fmt::format(" ({} at rest, not integrated)", slept) : "",
      scenario.method.get().hasFixedStep() ? counted(steps, "step") + ", " : "",
      counted(integrator.forceEvaluations(), "force evaluation"),
      durationText(std::max(summary.seconds - files.secondsWaited() - monitor.seconds(), 0.0)),
      writingText(files), durationText(monitor.seconds()), monitor.measurements(),
      toString(monitor.verdict().kind)));
}

int run(const Scenario& scenario, const Switches& switches) {
  const Particles particles = readParticles(scenario);
  const Chain chain(particles.masses, scenario.spring(), scenario.gravity);
  RunMonitor monitor(scenario, chain, particles.state, !scenario.energy.empty());
  const bool tracks_dissipation = monitor.tracksDissipation();
  SleepingIntegrator integrator(
      makeInterruptible(scenario, chain, particles.state, tracks_dissipation,
                        [] { return interruption() != 0; }),
      chain, scenario.sleep);
  if (switches.report_skips) printOutput(skippedWork(scenario, integrator, tracks_dissipation));
  const std::string memory = memoryRemark(scenario, chain.size());
  if (switches.check) {
    printRemark(memory);
    printOutput(describeStability(chain, particles.state, scenario));
    return kDone;
  }
  catchInterruptions();
  const std::string warning = stabilityWarning(chain, scenario);
  RunFiles files(scenario, switches.config);  // last, because it removes the frames of earlier runs
  printRemark(memory);
  printRemark(remarkOn(scenario));
  printWarning(warning);
  State state = particles.state;
  const Summary summary = simulate(scenario, state, integrator, monitor, files);
  files.finish();
  printSummary(scenario, summary, chain, integrator, files, monitor);
  return conclude(scenario, chain, particles.state, monitor.verdict(), monitor.toleranceRemark());
}

int runCommandLine(int argc, const char* const* argv) {
  const ProgramText program{
      "Exercise3",
      "Integrates the motion of a chain of particles and damped springs and writes its frames.",
      "Runge-Kutta-4 --particles particle.txt --output frames"};
  Scenario scenario;
  OptionSet options(scenarioOptions(scenario));
  const Switches switches = parseCommandLine(argc, argv, program, options, scenario);
  if (switches.answer.empty()) return run(scenario, switches);
  printOutput(switches.answer);
  return kDone;
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  return spring_pendulum::runProgram([&] { return spring_pendulum::runCommandLine(argc, argv); });
}
