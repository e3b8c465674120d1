// The exercise: carries a chain of particles through time and writes a file a frame.
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/io/command_line.hpp>
#include <spring_pendulum/io/frame_writer.hpp>
#include <spring_pendulum/io/interruption.hpp>
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/io/progress.hpp>
#include <spring_pendulum/model/errors.hpp>
#include <spring_pendulum/simulation/frame_steps.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>

namespace spring_pendulum {
namespace {

enum ExitStatus { kDone = 0, kFileFailed = 1, kBadInput = 2, kDiverged = 3, kSignalled = 128 };

/// What the closing line tells.
struct Summary {
  std::int64_t frames = 0;
  bool diverged = false;
  double seconds = 0.0;
};

/// The simulation loop: advance, judge, hand the frame to each output that is wanted.
Summary simulate(const Scenario& scenario, State& state, Integrator& integrator,
                 FrameWriter* writer) {
  const auto start = std::chrono::steady_clock::now();
  const FrameSteps step = frameSteps(scenario);
  Progress progress(scenario.frames);
  Summary summary;
  while (summary.frames < scenario.frames && interruption() == 0) {
    if (summary.frames > 0) integrator.advance(state, step.time_step, step.steps);
    summary.diverged = !state.values().allFinite();
    if (summary.diverged) break;
    if (writer != nullptr) writer->write(summary.frames, state);
    progress.show(++summary.frames);
  }
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return summary;
}

std::string counted(std::int64_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

void printSummary(const Scenario& scenario, const Summary& summary, Eigen::Index particles,
                  std::int64_t force_evaluations, double writing_seconds,
                  const std::string& folder) {
  const bool fixed = findMethod(scenario.method).control == StepControl::kFixed;
  const std::int64_t steps =
      std::max<std::int64_t>(summary.frames - 1, 0) * scenario.steps_per_frame;
  fmt::print(
      "{}: {}, {}, {}{}, {:.3f} s integrating, "
      "{:.3f} s writing{}\n",
      scenario.method, particles, summary.frames, fixed ? fmt::format("{} steps, ", steps) : "",
      force_evaluations, std::max(summary.seconds - writing_seconds, 0.0), writing_seconds,
      folder.empty() ? "" : " to " + folder);
}

int run(const Scenario& scenario) {
  const Particles particles = readParticleFile(scenario.particles);
  const Chain chain(particles.masses, scenario.spring(), scenario.gravity);
  const auto integrator = makeIntegrator(scenario.method, chain, {scenario.tolerance});
  std::optional<FrameWriter> writer;
  if (!scenario.no_frames) writer.emplace(scenario.output, scenario.frames);

  catchInterruptions();
  State state = particles.state;
  const Summary summary = simulate(scenario, state, *integrator, writer ? &*writer : nullptr);
  if (writer) writer->finish();
  printSummary(scenario, summary, chain.size(), integrator->forceEvaluations(),
               writer ? writer->seconds() : 0.0, writer ? writer->folder() : "");
  if (summary.diverged) {
    fmt::print(stderr, "the motion diverged before t = {:.6g} s: a smaller step would be right\n",
               frameSteps(scenario).timeOfFrame(summary.frames));
    return kDiverged;
  }
  return interruption() == 0 ? kDone : kSignalled + interruption();
}

int runCommandLine(int argc, const char* const* argv) {
  const CommandLine command_line = parseCommandLine(argc, argv);
  if (command_line.answer.empty()) return run(command_line.scenario);
  fmt::print("{}", command_line.answer);
  return kDone;
}

/// Foreign text in a message must not break its line.
int report(std::string message, ExitStatus status) {
  std::replace_if(
      message.begin(), message.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  std::fprintf(stderr, "%s\n", message.c_str());
  return status;
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  using namespace spring_pendulum;
  try {
    const int status = runCommandLine(argc, argv);
    if (std::fflush(stdout) != 0) throw FileError("standard output: could not be written");
    return status;
  } catch (const InputError& error) {
    return report(error.what(), kBadInput);
  } catch (const std::bad_alloc&) {
    return report("not enough memory for a chain of this length", kFileFailed);
  } catch (const std::exception& error) {
    return report(error.what(), kFileFailed);
  }
}
