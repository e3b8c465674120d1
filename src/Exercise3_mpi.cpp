// Exercise3 for one chain that is shared by many processes or machines.
#include "base/numbers.hpp"
#include "base/stopwatch.hpp"
#include "io/program/closing.hpp"
#include "io/program/command_line.hpp"
#include "io/program/exit_status.hpp"
#include "io/program/interruption.hpp"
#include "io/program/standard_streams.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/frame_steps.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <optional>

#include "mpi/chain_part.hpp"
#include "mpi/part_file.hpp"
#include "mpi/shared_files.hpp"

namespace spring_pendulum {
namespace {

void checkSupported(const Scenario& scenario, const Switches& switches) {
  const Method& method = scenario.method;
  const auto refuse = [](const std::string& what) {
    throw InputError(fmt::format("{}: not with Exercise3_mpi; use Exercise3", what));
  };
  if (!method.hasFixedStep()) {
    throw InputError(fmt::format(
        "{}: chooses its own steps; Exercise3_mpi needs a method with a fixed step", method.name));
  }
  if (switches.check) refuse("--check");
  if (switches.report_skips) refuse("--report-skips");
  if (scenario.sleep > 0.0) refuse("--sleep");
  if (scenario.start != Start::kFile) refuse("--start at_rest");
  if (scenario.air_drag > 0.0) refuse("--air-drag");
  if (scenario.reference == ReferenceUse::kAlways) refuse("--reference always");
}

/// What the closing line tells, besides the judge.
struct Totals {
  std::int64_t frames = 0;  ///< shown
  std::int64_t steps = 0;
  double seconds = 0.0;  ///< wall-clock time of integrating, with the exchange of borders
};

void printClosing(const Scenario& scenario, const Ranks& ranks, const ChainPart& part,
                  const Totals& totals, const SharedFiles& files, const Judge& judge) {
  const std::string destination = files.destination();
  printClosingLine(fmt::format(
      "{}: {} on {}, {}, {}, {} integrating, {} of it exchanging borders, {} summing energies{}, "
      "{}, "
      "verdict: {}",
      scenario.method.get().name, counted(part.particles(), "particle"),
      counted(ranks.size(), "rank"), counted(totals.frames, "frame"), counted(totals.steps, "step"),
      durationText(totals.seconds), durationText(part.secondsExchanging()),
      durationText(part.secondsSumming()),
      destination.empty()
          ? ""
          : fmt::format(", {} writing{}", durationText(files.secondsWriting()), destination),
      judge.measurements(), toString(judge.worst().kind)));
}

/// \returns the exit status
int conclude(const Verdict& verdict, int signal, bool prints) {
  if (prints && isBad(verdict.kind)) {
    printError((verdict.kind == VerdictKind::kDiverged ? "" : "warning: ") + verdict.text + "\n");
  }
  if (verdict.kind == VerdictKind::kDiverged) return kDiverged;
  return signal == 0 ? kDone : kSignalled + signal;
}

Judge makeJudge(const Ranks& ranks, const Scenario& scenario, const ChainPart& part,
                bool track_dissipation, double start_time) {
  const Energy start = part.totals().energy;
  const EnergyScaleSums sums = part.scaleSums();
  std::optional<Judge> judge;
  ranks.together([&] {
    judge.emplace(
        part.chain(), EnergyBalance(part.chain(), start, sums, track_dissipation, start_time),
        JudgeOptions{track_dissipation, scenario.method.get().symplectic ? scenario.time_step : 0.0,
                     0.0, start_time});
  });
  return *judge;
}

/// Reads the part of this rank. What was read is discarded before the run.
/// \param first set to the frame of the start
std::unique_ptr<ChainPart> makePart(const Ranks& ranks, const Scenario& scenario,
                                    bool track_dissipation, std::int64_t& first) {
  const Part part = readPart(ranks, scenario);
  first = part.own.frame;
  return std::make_unique<ChainPart>(ranks, scenario, part, track_dissipation);
}

/// The simulation loop of every rank.
int simulate(const Ranks& ranks, const Scenario& scenario, const Switches& switches) {
  ranks.together([&] { checkSupported(scenario, switches); });
  const bool track_dissipation =
      scenario.damping > 0.0 &&
      (!scenario.energy.empty() || scenario.method.get().tableau != nullptr);
  std::int64_t first = 0;
  const auto owned = makePart(ranks, scenario, track_dissipation, first);
  ChainPart& part = *owned;
  const FrameSteps steps = frameSteps(scenario);
  Judge judge = makeJudge(ranks, scenario, part, track_dissipation, steps.timeOfFrame(first));
  catchInterruptions();
  SharedFiles files(ranks, scenario, switches.config, first);
  Totals totals;
  int signal = 0;
  for (std::int64_t frame = first; frame < scenario.frames && signal == 0; ++frame) {
    bool complete = true;
    if (frame > first) {
      const Stopwatch stopwatch(totals.seconds);
      complete = part.advance(steps.time_step, steps.steps, [] { return interruption() != 0; });
    }
    // All ranks discard a frame that one of them gave up.
    const auto agreed = ranks.largest({interruption(), complete ? 0 : 1});
    signal = static_cast<int>(agreed[0]);
    if (agreed[1] != 0) break;
    if (frame > first) totals.steps += steps.steps;
    const auto [energy, dissipated] = part.totals();
    judge.judge(steps.timeOfFrame(frame), energy, dissipated);
    if (!judge.isShown(scenario.on_divergence == OnDivergence::kContinue)) break;
    files.write(frame, part, judge.entry());
    ++totals.frames;
  }
  files.finish(part);
  ranks.together([&] {
    if (ranks.isFirst()) printClosing(scenario, ranks, part, totals, files, judge);
  });
  return conclude(judge.worst(), signal, ranks.isFirst());
}

int runCommandLine(const Ranks& ranks, int argc, const char* const* argv) {
  const ProgramText program{
      "Exercise3_mpi",
      "Integrates the motion of a chain like Exercise3, on several processes or machines.",
      "Runge-Kutta-4 particle.txt --output frames"};
  Scenario scenario;
  OptionSet options(scenarioOptions(scenario));
  Switches switches;
  ranks.together([&] {
    switches = parseCommandLine(argc, argv, program, options, scenario);
    if (ranks.isFirst()) printOutput(switches.answer);
  });
  return switches.answer.empty() ? simulate(ranks, scenario, switches) : kDone;
}

/// \returns the exit status
int runRank(int argc, const char* const* argv) {
  const Ranks ranks;
  try {
    const int status = runCommandLine(ranks, argc, argv);
    ranks.together(flushOutput);
    return status;
  } catch (const RankFailure& failure) {
    return failure.status;
  } catch (const std::exception& error) {
    const Failure failure = failureOf(error);
    printError(failure.message + "\n");
    abortAllRanks(failure.status);
  }
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  spring_pendulum::prepareProcess();
  return spring_pendulum::runRank(argc, argv);
}
