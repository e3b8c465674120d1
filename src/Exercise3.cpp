// The exercise: integrates the motion of a chain of particles and writes one file per frame.
#include "io/program/command_line.hpp"
#include "io/program/program.hpp"
#include "io/program/progress.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/io/run_files.hpp>
#include <spring_pendulum/simulation/run.hpp>

namespace spring_pendulum {
namespace {

/// The simulation loop: advances the run frame by frame and writes each frame.
int simulate(const Scenario& scenario, const Switches& switches) {
  Run run(readScene(scenario), scenario, {!scenario.energy.empty(), 0.0, interruption});
  if (switches.has("check")) return printAdvice(run);
  catchInterruptions();
  const std::string remarks = startLines(run);
  RunFiles files(run, scenario, switches.config);  // last: removes the frames of earlier runs
  printError(remarks);
  Progress progress(scenario.frames, "frames");
  while (run.advance()) {
    files.write(run);
    progress.show(run.frame() + 1);
  }
  files.finish();
  printClosingLine(run.closingLine(files.closingText()));
  return conclude(run);
}

int runCommandLine(int argc, const char* const* argv) {
  const ProgramText program{
      "Exercise3",
      "Integrates the motion of a chain of particles and damped springs and writes its frames.",
      "Runge-Kutta-4 particle.txt --output frames"};
  Scenario scenario;
  OptionSet options(scenarioOptions(scenario));
  const Switches switches = parseCommandLine(argc, argv, program, options, scenario);
  if (switches.answer.empty()) return simulate(scenario, switches);
  printOutput(switches.answer);
  return kDone;
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  return spring_pendulum::runProgram([&] { return spring_pendulum::runCommandLine(argc, argv); });
}
