// Says what is wrong with the frames of another program for the exercise.
#include "check/check_frames.hpp"

#include "io/files/frame_folder_reader.hpp"
#include "io/program/command_line.hpp"
#include "io/program/exit_status.hpp"
#include "io/program/interruption.hpp"
#include "io/program/standard_streams.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace spring_pendulum {
namespace {

/// Exit status of each verdict.
constexpr int kStatus[] = {kDone, 4, 5};

/// Statuses by severity: unreadable, different, undecided, equal.
int severity(int status) {
  return status == kFileFailed ? 3 : status == 4 ? 2 : status == 5 ? 1 : 0;
}

/// Checks a folder and prints the result, in a table with columns of this width, or alone if it is 0.
/// \returns an exit status
int check(const std::string& folder, const Scenario& scenario, const Particles& particles,
          const CheckOptions& options, bool in_json, std::size_t width) {
  std::string text;
  int status = kFileFailed;
  try {
    const FrameCheck result = checkFrames(scenario, particles, readFrameFolder(folder), options);
    status = kStatus[static_cast<int>(result.verdict)];
    text = in_json ? jsonOf(result, folder) : width > 0 ? shortReportOf(result) : reportOf(result);
  } catch (const FileError& error) {
    if (interruption() != 0) {
      printError(fmt::format("{}: {}\n", folder, error.what()));
      return status;
    }
    if (!in_json && width == 0) throw;
    text =
        in_json ? jsonOfError(error.what(), folder) : fmt::format("unreadable: {}", error.what());
  }
  printOutput(width > 0 && !in_json ? fmt::format("{:<{}}  {}\n", folder, width, text) : text);
  flushOutput();
  return status;
}

/// \returns 1 if any folder is unreadable, else 4 if any is different, else 5 if any is undecided
int checkAll(const Scenario& scenario, const OptionSet& options, const Switches& switches) {
  if (scenario.start != Start::kFile) throw InputError("start: not with check_frames");
  const Particles particles = readParticles(scenario);
  catchInterruptions();
  std::size_t width = 0;
  for (const std::string& folder : switches.folders) width = std::max(width, folder.size());
  if (switches.folders.size() == 1) width = 0;
  int status = kDone;
  for (const std::string& folder : switches.folders) {
    const int one = check(folder, scenario, particles,
                          {options.isGiven("method"), [] { return interruption() != 0; }},
                          switches.has("json"), width);
    if (interruption() != 0) return kSignalled + interruption();
    if (severity(one) > severity(status)) status = one;
  }
  return status;
}

int runCommandLine(int argc, const char* const* argv) {
  const ProgramText program{
      "check_frames",
      "Compares frames with each method, and says which mistake is in the program that wrote them.",
      "frames --particles particle.txt",
      {{"json", "print a line of JSON for each folder"},
       {"list-mistakes", "describe the known mistakes", listOfMistakes}},
      "DIR ...",
      "0 equal, 1 could not read, 2 wrong use or bad input, 4 different,\n"
      "5 undecided: frames are missing or too sensitive to compare, 128 + n stopped by signal n.",
      {"method", "particles", "resume", "frames", "steps_per_frame", "time_step", "tolerance",
       "frame_interval", "stiffness", "damping", "rest_length", "gravity", "air_drag"}};
  registerCourseMethods();
  Scenario scenario;
  OptionSet options(scenarioOptions(scenario));
  const Switches switches = parseCommandLine(argc, argv, program, options, scenario);
  if (switches.answer.empty()) return checkAll(scenario, options, switches);
  printOutput(switches.answer);
  return kDone;
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  return spring_pendulum::runProgram([&] { return spring_pendulum::runCommandLine(argc, argv); });
}
