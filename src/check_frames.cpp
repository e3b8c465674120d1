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

constexpr int kDifferent = 4;
constexpr int kUndecided = 5;

struct Row {
  int status = kDone;
  std::string text;
};

Row check(const std::string& folder, const Scenario& scenario, const Particles& particles,
          const CheckOptions& options, const Switches& switches) {
  const bool is_table = switches.folders.size() > 1;
  try {
    const FrameCheck result = checkFrames(scenario, particles, readFrameFolder(folder), options);
    const int status = result.verdict == FrameVerdict::kEqual       ? kDone
                       : result.verdict == FrameVerdict::kDifferent ? kDifferent
                                                                    : kUndecided;
    if (switches.json) return {status, jsonOf(result, folder)};
    return {status, is_table ? shortReportOf(result) : reportOf(result)};
  } catch (const FileError& error) {
    if (interruption() != 0) {
      printError(fmt::format("{}: {}\n", folder, error.what()));
      return {};
    }
    if (switches.json) return {kFileFailed, jsonOfError(error.what(), folder)};
    if (!is_table) throw;
    return {kFileFailed, fmt::format("unreadable: {}", error.what())};
  }
}

int severity(int status) {
  return status == kFileFailed ? 3 : status == kDifferent ? 2 : status == kUndecided ? 1 : 0;
}

/// \returns 1 if any folder is unreadable, else 4 if any is different, else 5 if any is undecided
int checkAll(const Scenario& scenario, const OptionSet& options, const Switches& switches) {
  if (scenario.air_drag > 0.0) throw InputError("air_drag: not with check_frames");
  if (scenario.start != Start::kFile) throw InputError("start: not with check_frames");
  const Particles particles = readParticles(scenario);
  catchInterruptions();
  std::size_t width = 0;
  for (const std::string& folder : switches.folders) width = std::max(width, folder.size());
  int status = kDone;
  for (const std::string& folder : switches.folders) {
    if (interruption() != 0) break;
    const Row row =
        check(folder, scenario, particles,
              {options.isGiven("method"), [] { return interruption() != 0; }}, switches);
    if (row.text.empty()) break;  // interrupted
    const bool is_table = switches.folders.size() > 1 && !switches.json;
    printOutput(is_table ? fmt::format("{:<{}}  {}\n", folder, width, row.text) : row.text);
    flushOutput();
    if (severity(row.status) > severity(status)) status = row.status;
  }
  return interruption() == 0 ? status : kSignalled + interruption();
}

int runCommandLine(int argc, const char* const* argv) {
  const ProgramText program{
      "check_frames",
      "Compares the frames in folders with each method, and says which mistake is in the program\n"
      "that wrote them.",
      "frames --particles particle.txt",
      "DIR ...",
      "0 equal, 1 could not read, 2 wrong use or bad input, 4 different,\n"
      "5 undecided: frames are missing or too sensitive to compare, 128 + n stopped by signal n.",
      {"method", "particles", "resume", "frames", "steps_per_frame", "time_step", "tolerance",
       "frame_interval", "stiffness", "damping", "rest_length", "gravity"}};
  Scenario scenario;
  OptionSet options(scenarioOptions(scenario));
  const Switches switches = parseCommandLine(argc, argv, program, options, scenario);
  if (switches.answer.empty() && !switches.list_mistakes)
    return checkAll(scenario, options, switches);
  printOutput(switches.list_mistakes ? listOfMistakes() : switches.answer);
  return kDone;
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  return spring_pendulum::runProgram([&] { return spring_pendulum::runCommandLine(argc, argv); });
}
