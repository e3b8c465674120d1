// The exercise: carries a chain of particles through time and writes a file a frame.
#include "io/background_frame_writer.hpp"
#include "io/command_line.hpp"
#include "io/energy_file.hpp"
#include "io/failure.hpp"
#include "io/interruption.hpp"
#include "io/progress.hpp"
#include "simulation/scenario_options.hpp"
#include "simulation/sleep.hpp"
#include "simulation/work.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/model/errors.hpp>
#include <spring_pendulum/simulation/frame_steps.hpp>
#include <spring_pendulum/simulation/stability_advice.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>

namespace spring_pendulum {
namespace {

/// What the closing line tells.
struct Summary {
  std::int64_t frames = 0;
  double seconds = 0.0;
};

/// Where a frame goes; null where it is not wanted.
struct Outputs {
  BackgroundFrameWriter* frames = nullptr;
  EnergyFile* energy = nullptr;
};

/// What diverged is never shown, unless somebody wants to see it and there still is something.
bool isShown(const Judge& judge, bool continues) {
  if (judge.latest().kind != VerdictKind::kDiverged) return true;
  return continues && std::isfinite(judge.entry().energy.total());
}

/// The simulation loop: advance, judge, hand the frame to each output that is wanted.
Summary simulate(const Scenario& scenario, State& state, Integrator& integrator, Judge& judge,
                 const Outputs& outputs) {
  const auto start = std::chrono::steady_clock::now();
  const FrameSteps step = frameSteps(scenario);
  const bool continues = scenario.on_divergence == OnDivergence::kContinue;
  Progress progress(scenario.frames);
  Summary summary;
  while (summary.frames < scenario.frames && interruption() == 0) {
    if (summary.frames > 0) integrator.advance(state, step.time_step, step.steps);
    judge.judge(step.timeOfFrame(summary.frames), state, integrator.dissipatedEnergy());
    if (!isShown(judge, continues)) break;
    if (outputs.frames != nullptr) outputs.frames->write(summary.frames, state);
    if (outputs.energy != nullptr) outputs.energy->write(summary.frames, judge.entry());
    progress.show(++summary.frames);
  }
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return summary;
}

std::string counted(std::int64_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

void printSummary(const Scenario& scenario, const Summary& summary, const Chain& chain,
                  const SleepingIntegrator& integrator, const BackgroundFrameWriter* writer,
                  const Judge& judge) {
  const bool fixed = findMethod(scenario.method).control == StepControl::kFixed;
  const std::int64_t slept = integrator.sleptCalls();
  const std::int64_t steps =
      std::max<std::int64_t>(summary.frames - 1 - slept, 0) * scenario.steps_per_frame;
  const double waited = writer == nullptr ? 0.0 : writer->secondsWaited();
  const double writing = writer == nullptr ? 0.0 : writer->secondsWriting();
  const std::string report = integrator.report();
  fmt::print("{}{}: {}, {}{}, {}{}, {:.3f} s integrating, {:.3f} s writing{}, verdict: {}\n",
             scenario.method, report.empty() ? "" : " (" + report + ")",
             counted(chain.size(), "particle"), counted(summary.frames, "frame"),
             slept > 0 ? fmt::format(" ({} at rest, not stepped)", slept) : "",
             fixed ? counted(steps, "step") + ", " : "",
             counted(integrator.forceEvaluations(), "force evaluation"),
             std::max(summary.seconds - waited, 0.0), writing,
             writer == nullptr ? "" : " to " + writer->folder(), toString(judge.worst().kind));
}

void warn(const std::string& text) {
  if (!text.empty()) fmt::print(stderr, "warning: {}\n", text);
}

/// The warning or error on standard error, and the exit status.
int conclude(const Scenario& scenario, const Chain& chain, const State& start,
             const Verdict& verdict) {
  if (verdict.kind == VerdictKind::kDiverged) {
    fmt::print(stderr, "{}; {}\n", verdict.text, remedyForDivergence(chain, start, scenario));
    return kDiverged;
  }
  if (verdict.kind != VerdictKind::kOk) warn(verdict.text);
  return interruption() == 0 ? kDone : kSignalled + interruption();
}

void reportSkips(const Scenario& scenario, const Integrator& integrator) {
  for (const std::string& skipped : skippedWork(scenario, integrator, !scenario.energy.empty())) {
    fmt::print("skipped: {}\n", skipped);
  }
}

int run(const Scenario& scenario, const Switches& switches) {
  const Particles particles = readParticleFile(scenario.particles);
  const Chain chain(particles.masses, scenario.spring(), scenario.gravity);
  const bool wants_energy = !scenario.energy.empty();
  SleepingIntegrator integrator(
      makeIntegrator(scenario.method, chain, integratorOptions(scenario, wants_energy)), chain,
      scenario.sleep);
  if (switches.report_skips) reportSkips(scenario, integrator);
  Judge judge(chain, particles.state, wants_energy);
  if (switches.check) {
    fmt::print("{}", describeStability(chain, particles.state, scenario));
    return kDone;
  }
  std::optional<EnergyFile> energy;
  if (wants_energy) energy.emplace(scenario.energy);
  std::optional<BackgroundFrameWriter> writer;
  if (!scenario.no_frames) writer.emplace(scenario.output, scenario.frames);

  catchInterruptions();
  State state = particles.state;
  const Outputs outputs{writer ? &*writer : nullptr, energy ? &*energy : nullptr};
  const Summary summary = simulate(scenario, state, integrator, judge, outputs);
  if (writer) writer->finish();
  if (energy) energy->finish();
  printSummary(scenario, summary, chain, integrator, outputs.frames, judge);
  return conclude(scenario, chain, particles.state, judge.worst());
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
  fmt::print("{}", switches.answer);
  return kDone;
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  using namespace spring_pendulum;
  std::signal(SIGPIPE, SIG_IGN);  // a reader that has gone away is an error like any other
  try {
    const int status = runCommandLine(argc, argv);
    if (std::fflush(stdout) != 0) throw FileError("standard output: could not be written");
    return status;
  } catch (const std::exception& error) {
    const Failure failure = failureOf(error);
    std::fprintf(stderr, "%s\n", failure.message.c_str());
    return failure.status;
  }
}
