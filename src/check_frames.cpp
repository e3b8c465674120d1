// Says what is wrong with the frames of another program for the exercise.
#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "check/checker.hpp"
#include "io/files/posix.hpp"
#include "io/files/touched_files.hpp"
#include "io/program/command_line.hpp"
#include "io/program/program.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/run_files.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <utility>

namespace spring_pendulum {
namespace {

constexpr std::pair<const char*, ButcherTableau> kCourseMethods[] = {
    {"Heun", {2, {{{}, {1.0}}}, {0.5, 0.5}}}, {"Ralston", {2, {{{}, {2.0 / 3.0}}}, {0.25, 0.75}}}};

/// \param text a number, or a fraction such as 2/3
double coefficientOf(const std::string& text, const std::string& path) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto above = parseNumber(text.substr(0, slash));
  const auto below = parseNumber(slash == text.size() ? "1" : text.substr(slash + 1));
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
    if (row.size() != ++tableau.stages || tableau.stages >= ButcherTableau::kMaxStages)
      throw InputError(
          fmt::format("{}: line n must have n numbers, the last one the weights; at most {}", path,
                      ButcherTableau::kMaxStages - 1));
    std::copy(row.begin(), row.end(), tableau.a[tableau.stages].begin());
  }
  tableau.b = std::exchange(tableau.a[tableau.stages], {});
  const std::string name = std::filesystem::path(path).filename();
  registerMethod(methodOfTableau("tableau " + onOneLine(name), tableau));
  return methodTable().back();
}

/// Exit status of each verdict and of a folder that could not be read, by severity.
constexpr int kStatus[] = {kDone, 5, 4, kFileFailed};

/// Checks the folders and prints the results, as a table if there are several.
/// \returns 1 if any folder is unreadable, else 4 if any is different, else 5 if any is undecided
int checkAll(const Scenario& scenario, bool method_is_given,
             const std::vector<std::string>& folders) {
  const Scene particles = readScene(scenario);
  catchInterruptions();
  const bool is_table = folders.size() > 1;
  std::size_t width = 0, worst = 0;
  for (const std::string& folder : folders) width = std::max(width, folder.size());
  for (const std::string& folder : folders) {
    std::string row;
    std::size_t severity = 3;
    try {
      const FrameCheck result = checkFrames(scenario, particles, readFrameFolder(folder),
                                            method_is_given, [] { return interruption() != 0; });
      severity = static_cast<std::size_t>(result.verdict);
      row = fmt::format("{}", fmt::join(result.lines, is_table ? "; " : "\n"));
    } catch (const FileError& error) {
      if (interruption() != 0) printError(fmt::format("{}: {}\n", folder, error.what()));
      if (interruption() != 0) break;
      if (!is_table) throw;
      row = fmt::format("unreadable: {}", error.what());
    }
    printOutput((is_table ? onOneLine(fmt::format("{:<{}}  {}", folder, width, row)) : row) + '\n');
    flushOutput();
    worst = std::max(worst, severity);
  }
  return interruption() != 0 ? kSignalled + interruption() : kStatus[worst];
}

int runCommandLine(int argc, const char* const* argv) {
  const ProgramText program{
      "check_frames",
      "Compares frames with each method, and says which mistake is in the program that wrote them.",
      "frames --particles particle.txt",
      {},
      "DIR ...",
      "0 equal, 1 could not read, 2 wrong use or bad input, 4 different,\n"
      "5 undecided: frames are missing or too sensitive to compare, 128 + n stopped by signal n.",
      {"method", "particles", "resume", "frames", "steps_per_frame", "time_step", "tolerance",
       "frame_interval", "stiffness", "damping", "rest_length", "gravity", "air_drag", "tableau"}};
  for (const auto& [name, tableau] : kCourseMethods) {
    Method method = methodOfTableau(name, tableau);
    method.use = "of other courses: right only if it is asked for";
    registerMethod(method);
  }
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
  const bool is_given = options.isGiven("method") || options.isGiven("tableau");
  printOutput(switches.answer);
  if (!switches.answer.empty()) return kDone;
  TouchedFiles touched{{scenario.particles, switches.config, tableau}, {}, ""};
  for (const std::string& folder : switches.folders) {
    std::error_code ignored;  // reported when the frames are read
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
      if (entry.path().filename().string().rfind("frame_", 0) == 0)
        touched.inputs.push_back(entry.path());
  }
  checkTouchedFiles(touched);  // the report must not be appended to a frame
  return checkAll(scenario, is_given, switches.folders);
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  return spring_pendulum::runProgram([&] { return spring_pendulum::runCommandLine(argc, argv); });
}
