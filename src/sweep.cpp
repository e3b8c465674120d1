// Runs the cases of a study on all cores, ranks or shards and writes one table.
#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "io/files/touched_files.hpp"
#include "io/formats/state_file.hpp"
#include "io/program/command_line.hpp"
#include "io/program/program.hpp"
#include "simulation/options/scenario_options.hpp"
#include "sweep/sweep_run.hpp"
#include "sweep/table.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <boost/program_options/value_semantic.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

namespace spring_pendulum::sweep {
namespace {

namespace po = boost::program_options;

struct CommandLine {
  std::string answer;  ///< text to print instead of a sweep: --help, --version
  std::string study;
  std::string shard = "1/1";
  std::int64_t only_case = -1;  ///< negative: all
  SweepOptions sweep;           ///< with --case, `output` is the folder of the frames; empty: none
};

std::vector<Option> optionsOf(CommandLine& line) {
  return {
      {"output", Text{&line.sweep.output, "FILE", "a file"}, "",
       "table of all cases [STUDY.csv]; with --case a folder for its frames"},
      {"case", Count{&line.only_case, Range::atLeast(0)}, "",
       "print case N as a command line of Exercise3"},
      {"threads", Count{&line.sweep.threads, Range::between(1, 1024)}, "",
       "number of threads; the table does not depend on it [one per core]"},
      {"shard", Text{&line.shard, "I/N", "I/N"}, "",
       "run only part I of N, counted from 1; the last to finish writes the table"},
      {"plot", Flag{&line.sweep.plot}, "", "draw the table as PNG with matplotlib"},
  };
}

std::string helpText(const po::options_description& description) {
  std::ostringstream options;
  options << description;
  std::string columns;
  for (const Column& column : allColumns())
    columns += fmt::format("  {:<20} {}\n", column.name, column.meaning);
  return fmt::format(
      "Runs the cases of a study and writes their table.\n\nUsage: sweep STUDY.yaml [options]\n"
      "Example: sweep config/studies/order.yaml --plot\n\n{}\nColumns of a table:\n{}\n"
      "Exit status: 0 done, 1 could not read or write, 2 wrong use or bad input,\n"
      "128 + n stopped by signal n.\n",
      options.str(), columns);
}

void setShard(CommandLine& line) {
  const std::size_t slash = std::min(line.shard.find('/'), line.shard.size() - 1);
  const auto part = parseInteger(line.shard.substr(0, slash));
  const auto parts = parseInteger(line.shard.substr(slash + 1));
  if (!part || !parts || *part < 1 || *part > *parts || static_cast<double>(*parts) > kMostCases)
    throw InputError(fmt::format("--shard: must be I/N with I from 1 to N, N at most 1e9, got {}",
                                 inQuotes(line.shard)));
  line.sweep.shard = *part;
  line.sweep.shards = *parts;
}

CommandLine parseCommandLine(int argc, const char* const* argv) {
  CommandLine line;
  OptionSet options(optionsOf(line));
  po::options_description description("Options", 90, 45);
  for (const Option& option : options.options()) {
    const std::string name = option.key == "output" ? "output,o" : std::string(option.key);
    const std::string meaning(option.meaning);
    if (option.isFlag()) {
      description.add_options()(name.c_str(), meaning.c_str());
      continue;
    }
    const auto* const value = po::value<std::string>()->value_name(option.placeholder());
    description.add_options()(name.c_str(), value, meaning.c_str());
  }
  description.add_options()("version", "show the version")("help,h", "show this help");
  for (const po::option& argument : splitArguments(argc, argv, description)) {
    const std::string& key = argument.string_key;
    if (key == "help") line.answer = helpText(description);
    if (key == "version") line.answer = "spring_pendulum " SPRING_PENDULUM_VERSION "\n";
    if (!line.answer.empty()) return line;
    const std::string text = argument.value.empty() ? "true" : argument.value.front();
    if (!key.empty())
      options.set(options.find(key, ""), text, "--" + key);
    else if (line.study.empty())
      line.study = text;
    else
      throw InputError(inQuotes(text) + ": give only one STUDY");
  }
  for (const char* const other : {"plot", "shard", "threads"}) {
    if (!options.isGiven("case") || !options.isGiven(other)) continue;
    throw InputError(fmt::format("--case: runs a single case; leave out --{}", other));
  }
  if (line.study.empty())
    throw InputError(
        "STUDY is missing; try: sweep config/studies/order.yaml (--help lists the options)");
  setShard(line);
  if (line.only_case < 0 && line.sweep.output.empty())
    line.sweep.output = std::filesystem::path(line.study).stem().string() + ".csv";
  return line;
}

/// A word of a shell command.
std::string word(const std::string& text) {
  const bool is_plain = text.find_first_not_of(
                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                            "0123456789-_./+=:,@%") == std::string::npos;
  if (is_plain && !text.empty()) return text;
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

/// The options that differ from their defaults and that the method uses.
std::string commandLine(const Scenario& scenario) {
  Scenario copy = scenario, defaults;
  const std::vector<Option> options = scenarioOptions(copy), by_default = scenarioOptions(defaults);
  const std::string here = scenario.particles.compare(0, 1, "-") == 0 ? "./" : "";
  std::string text = fmt::format("Exercise3 {} --particles {}", scenario.method.get().name,
                                 word(here + scenario.particles));
  for (std::size_t i = 0; i < options.size(); ++i) {
    const Option& option = options[i];
    if (option.key == "method" || option.key == "particles") continue;
    if (!option.isUsedBy(scenario.method) || option.text() == by_default[i].text()) continue;
    std::string name(option.key);
    std::replace(name.begin(), name.end(), '_', '-');
    text += " --" + name + (option.isFlag() ? "" : " " + word(option.text()));
  }
  return text + "\n";
}

/// The particle file of a case whose particles are in no file.
std::string particlesPath(const std::string& folder, std::int64_t index) {
  return fmt::format("{}/case_{}.txt", folder, index);
}

/// Prints a case as a command line of Exercise3.
/// \param folder for the frames, and for particles that are in no file; empty: none
void printCase(const Study& study, std::int64_t index, const std::string& folder) {
  if (index >= study.cases())
    throw InputError(fmt::format("--case: must be from 0 to {}, got {}", study.cases() - 1, index));
  Case made = caseOf(study, index);
  Scenario& scenario = made.settings.scenario;
  if (!folder.empty()) scenario.output = folder;
  const Run checked(made.scene(), scenario);  // before anything is written
  if (study.changesParticles(made.settings)) {
    if (folder.empty())
      throw InputError("--case: its particles are in no file; give a folder with --output");
    scenario.particles = particlesPath(folder, index);
    writeStateFile(scenario.particles, checked.chain(), made.particles.state, 0, 0.0);
  }
  printOutput(commandLine(scenario));
}

Study readCheckedStudy(const CommandLine& line) {
  Study study = readStudy(line.study);
  const std::string& output = line.sweep.output;
  TouchedFiles files{{line.study}, {}, ""};
  for (const auto& [path, particles] : study.particles) files.inputs.push_back(path);
  if (line.only_case < 0) {
    files.outputs = {output, output + ".journal", fmt::format("{}.{}", output, line.sweep.shard)};
  } else if (!output.empty()) {
    files.frame_folder = output;
    files.outputs = {particlesPath(output, line.only_case)};
  }
  for (const std::string& shard : {std::string(), fmt::format(".{}", line.sweep.shard)})
    if (line.sweep.plot) files.outputs.push_back(picturePath(output) + shard);
  checkTouchedFiles(files);
  if (!line.sweep.plot || !study.plot.empty()) return study;
  throw InputError("--plot: the study has no entry plot");
}

int run(int argc, const char* const* argv) {
  const CommandLine line = parseCommandLine(argc, argv);
  printOutput(line.answer);
  if (line.answer.empty() && line.only_case >= 0)
    printCase(readCheckedStudy(line), line.only_case, line.sweep.output);
  if (!line.answer.empty() || line.only_case >= 0) return kDone;
  const std::unique_ptr<CaseCounter> counter = makeCaseCounter(line.sweep.shards > 1);
  try {
    // Rank 0 checks everything first, so each error is reported once.
    if (counter->rank() > 0) counter->largest(0);
    return runSweep(readCheckedStudy(line), line.sweep, *counter);
  } catch (const std::exception& error) {  // a failure of one rank ends all of them
    const Failure failure = failureOf(error);
    printError(failure.message + "\n");
    return counter->abort(failure.status);
  }
}

}  // namespace
}  // namespace spring_pendulum::sweep

int main(int argc, char** argv) {
  return spring_pendulum::runProgram([&] { return spring_pendulum::sweep::run(argc, argv); });
}
