#include "sweep/command_line.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "io/program/arguments.hpp"
#include "simulation/options/option_set.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <boost/program_options/value_semantic.hpp>
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <set>
#include <sstream>

#include "sweep/table.hpp"

namespace spring_pendulum::sweep {
namespace {

namespace po = boost::program_options;

constexpr unsigned kLineLength = 90;

po::options_description describe() {
  po::options_description description("Options", kLineLength, kLineLength / 2);
  const auto add = [&](const char* name, const char* placeholder, const char* help) {
    description.add_options()(name, po::value<std::string>()->value_name(placeholder), help);
  };
  add("output,o", "FILE", "table of all cases [STUDY.csv]; with --case a folder for its frames");
  add("case", "N", "print case N as a command line of Exercise3");
  add("threads", "N", "number of threads; the table does not depend on it [one per core]");
  add("shard", "I/N", "run only part I of N, counted from 1; the last part writes the table");
  description.add_options()("plot", "draw the table as PNG with matplotlib")(
      "version", "show the version")("help,h", "show this help");
  return description;
}

std::string helpText(const po::options_description& description) {
  std::ostringstream options;
  options << description;
  std::string columns;
  for (const Column& column : allColumns()) {
    columns += fmt::format("  {:<20} {}\n", column.name, column.meaning);
  }
  return fmt::format(
      "Runs the cases of a study and writes their table.\n\nUsage: sweep STUDY.yaml [options]\n"
      "Example: sweep config/studies/order.yaml --plot\n\n{}\nColumns of a table:\n{}\n"
      "Exit status: 0 done, 1 could not read or write, 2 wrong use or bad input,\n"
      "128 + n stopped by signal n.\n",
      options.str(), columns);
}

std::int64_t countOf(const po::option& argument, const Range& range) {
  std::int64_t count = 0;
  const Option option{argument.string_key, Count{&count, range}, "", ""};
  OptionSet({option}).set(option, argument.value.front(), "--" + argument.string_key);
  return count;
}

void setShard(const std::string& text, SweepOptions& options) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const std::optional<std::int64_t> part = parseInteger(text.substr(0, slash));
  const std::optional<std::int64_t> parts =
      parseInteger(text.substr(std::min(slash + 1, text.size())));
  if (!part || !parts || *part < 1 || *part > *parts || static_cast<double>(*parts) > kMostCases) {
    throw InputError(fmt::format("--shard: must be I/N with I from 1 to N, N at most 1e9, got {}",
                                 inQuotes(text)));
  }
  options.shard = *part;
  options.shards = *parts;
}

void setOption(const po::option& argument, CommandLine& line) {
  const std::string& key = argument.string_key;
  if (key == "plot") line.options.plot = true;
  if (key == "output") {
    line.options.output = argument.value.front();
    if (line.options.output.empty()) throw InputError("--output: must be a file, got ''");
  }
  if (key == "case") line.only_case = countOf(argument, Range::atLeast(0));
  if (key == "threads") line.options.threads = countOf(argument, Range::between(1, 1024));
  if (key == "shard") setShard(argument.value.front(), line.options);
  if (!key.empty()) return;
  if (!line.study.empty())
    throw InputError(inQuotes(argument.value.front()) + ": give only one STUDY");
  line.study = argument.value.front();
}

}  // namespace

CommandLine parseCommandLine(int argc, const char* const* argv) {
  const po::options_description description = describe();
  CommandLine line;
  std::set<std::string> given;
  for (const po::option& argument : splitArguments(argc, argv, description)) {
    if (argument.string_key == "help") return {helpText(description), "", -1, {}};
    if (argument.string_key == "version") {
      return {"spring_pendulum " SPRING_PENDULUM_VERSION "\n", "", -1, {}};
    }
    if (!argument.string_key.empty() && !given.insert(argument.string_key).second) {
      throw InputError("--" + argument.string_key + ": is given twice");
    }
    setOption(argument, line);
  }
  for (const char* const other : {"plot", "shard", "threads"}) {
    if (given.count("case") + given.count(other) == 2) {
      throw InputError(fmt::format("--case: runs a single case; leave out --{}", other));
    }
  }
  if (line.study.empty()) {
    throw InputError(
        "STUDY is missing; try: sweep config/studies/order.yaml (--help lists the options)");
  }
  if (line.only_case < 0 && line.options.output.empty()) {
    line.options.output = std::filesystem::path(line.study).stem().string() + ".csv";
  }
  return line;
}

}  // namespace spring_pendulum::sweep
