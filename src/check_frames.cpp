// Says what is wrong with the frames of another program for the exercise.
#include "check/check_frames.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "io/files/frame_folder.hpp"
#include "io/files/posix.hpp"
#include "io/program/command_line.hpp"
#include "io/program/program.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/run_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace spring_pendulum {
namespace {

/// \param text a number, or a fraction such as 2/3
double coefficientOf(const std::string& text, const std::string& path) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const std::optional<double> above = parseNumber(text.substr(0, slash));
  const std::optional<double> below =
      slash == text.size() ? 1.0 : parseNumber(text.substr(slash + 1));
  if (!above || !below || *below == 0.0)
    throw InputError(fmt::format("{}: {} is not a number", path, inQuotes(text)));
  return *above / *below;
}

/// Registers the explicit Runge-Kutta method in a file: for each stage but the first a line with the
/// coefficients of the stages before, then a line with the weights.
/// \throws FileError, and InputError naming the file
const Method& registerTableau(const std::string& path) {
  ButcherTableau tableau;
  std::istringstream lines(readTextFile(path));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::vector<double> row;
    for (std::string word; words >> word;) row.push_back(coefficientOf(word, path));
    if (row.empty()) continue;
    if (row.size() != ++tableau.stages || tableau.stages >= ButcherTableau::kMaxStages) {
      throw InputError(
          fmt::format("{}: line n must have n numbers, the last one the weights; at most {}", path,
                      ButcherTableau::kMaxStages - 1));
    }
    tableau.b = {};
    std::copy(row.begin(), row.end(), tableau.b.begin());
    tableau.a[tableau.stages] = tableau.b;
  }
  tableau.a[tableau.stages] = {};
  const std::string name = std::filesystem::path(path).filename();
  registerMethod(methodOfTableau("tableau " + onOneLine(name), tableau));
  return methodTable().back();
}

/// Exit status of each verdict and of a folder that could not be read, by severity.
constexpr int kStatus[] = {kDone, 5, 4, kFileFailed};

/// Checks a folder and prints the result, in a table with columns of this width, or alone if it is 0.
/// \returns the index of its exit status
int check(const std::string& folder, const Scenario& scenario, const Scene& particles,
          bool method_is_given, std::size_t width) {
  std::string row;
  int severity = 3;
  try {
    const FrameCheck result = checkFrames(scenario, particles, readFrameFolder(folder),
                                          {method_is_given, [] { return interruption() != 0; }});
    severity = static_cast<int>(result.verdict);
    if (width == 0) printOutput(reportOf(result));
    row = result.result;
    for (const std::string& note : result.notes) row += "; note: " + note;
  } catch (const FileError& error) {
    if (interruption() != 0) {
      printError(fmt::format("{}: {}\n", folder, error.what()));
      return severity;
    }
    if (width == 0) throw;
    row = fmt::format("unreadable: {}", error.what());
  }
  if (width > 0) printOutput(fmt::format("{:<{}}  {}\n", folder, width, row));
  flushOutput();
  return severity;
}

/// \returns 1 if any folder is unreadable, else 4 if any is different, else 5 if any is undecided
int checkAll(const Scenario& scenario, const OptionSet& options, const Switches& switches) {
  if (scenario.start != Start::kFile) throw InputError("start: not with check_frames");
  const Scene particles = readScene(scenario);
  catchInterruptions();
  std::size_t width = 0;
  for (const std::string& folder : switches.folders) width = std::max(width, folder.size());
  if (switches.folders.size() == 1) width = 0;
  const bool is_given = options.isGiven("method") || options.isGiven("tableau");
  int severity = 0;
  for (const std::string& folder : switches.folders) {
    severity = std::max(severity, check(folder, scenario, particles, is_given, width));
    if (interruption() != 0) return kSignalled + interruption();
  }
  return kStatus[severity];
}

int runCommandLine(int argc, const char* const* argv) {
  const ProgramText program{
      "check_frames",
      "Compares frames with each method, and says which mistake is in the program that wrote them.",
      "frames --particles particle.txt",
      {{"list-mistakes", "describe the known mistakes", listOfMistakes}},
      "DIR ...",
      "0 equal, 1 could not read, 2 wrong use or bad input, 4 different,\n"
      "5 undecided: frames are missing or too sensitive to compare, 128 + n stopped by signal n.",
      {"method", "particles", "resume", "frames", "steps_per_frame", "time_step", "tolerance",
       "frame_interval", "stiffness", "damping", "rest_length", "gravity", "air_drag", "tableau"}};
  registerCourseMethods();
  Scenario scenario;
  std::string tableau;
  OptionSet options(scenarioOptions(scenario));
  options.add(
      {{"tableau", Text{&tableau, "FILE", "a file"}, "",
        "explicit Runge-Kutta method that the frames should have, see docs/check_frames.md"}});
  const Switches switches = parseCommandLine(argc, argv, program, options, scenario);
  if (options.isGiven("tableau")) {
    if (options.isGiven("method")) throw InputError("tableau: not together with method");
    scenario.method = registerTableau(tableau);
    refuseUnused(options, scenario);
  }
  if (switches.answer.empty()) return checkAll(scenario, options, switches);
  printOutput(switches.answer);
  return kDone;
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  return spring_pendulum::runProgram([&] { return spring_pendulum::runCommandLine(argc, argv); });
}
