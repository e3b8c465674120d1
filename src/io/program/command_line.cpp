#include "io/program/command_line.hpp"

#include "base/spelling.hpp"
#include "io/files/posix.hpp"
#include "io/formats/yaml_tree.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <boost/program_options/errors.hpp>
#include <boost/program_options/parsers.hpp>
#include <boost/program_options/value_semantic.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string_view>
#include <vector>

namespace spring_pendulum {
namespace {

namespace po = boost::program_options;

constexpr std::string_view kMethodKey = "method";
constexpr unsigned kLineLength = 90;

std::string unknownOption(const std::string& name, const po::options_description& description) {
  std::vector<std::string> known;
  for (const auto& option : description.options()) known.push_back("--" + option->long_name());
  return unknownName("option", name, known);
}

/// `time-step` for `time_step`
std::string optionName(std::string_view key) {
  std::string name(key);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

void addWithValue(po::options_description& description, const std::string& name,
                  const std::string& placeholder, const std::string& help) {
  const bool has_letter = name == "particles" || name == "output";
  const std::string names = has_letter ? name + ',' + name[0] : name;  // "particles,p"
  // The blank separates the longest option from its text by two, as help2man needs it.
  auto* const value = po::value<std::string>()->value_name(placeholder + ' ');
  description.add_options()(names.c_str(), value, help.c_str());
}

bool isOnCommandLine(const Option& option, const ProgramText& program) {
  const auto& keys = program.keys;
  if (!program.takesFolders()) return option.key != kMethodKey;
  return std::find(keys.begin(), keys.end(), option.key) != keys.end();
}

std::string listOfMethods() {
  std::string lists[2] = {"Methods with a fixed step (--time-step, --steps-per-frame):\n",
                          "\nError-controlled methods (--tolerance, --frame-interval):\n"};
  for (const Method& method : methodTable()) {
    lists[method.hasFixedStep() ? 0 : 1] +=
        fmt::format("  {:<20} order {}\n      {}\n", method.name, method.order, method.use);
  }
  return lists[0] + lists[1];
}

std::vector<Switch> switchesOf(const ProgramText& program) {
  std::vector<Switch> switches = program.switches;
  switches.push_back({"list-methods", "describe the methods", listOfMethods});
  switches.push_back({"version", "show the version",
                      [] { return "spring_pendulum " SPRING_PENDULUM_VERSION "\n"; }});
  return switches;
}

/// All options except METHOD, for the parser and the help text.
po::options_description describe(const OptionSet& options, const ProgramText& program) {
  po::options_description description("Options", kLineLength, kLineLength / 2);
  addWithValue(description, "config", "FILE",
               "YAML file with these options, underscores for dashes; the command line wins");
  for (const Option& option : options.options()) {
    const std::string name = optionName(option.key);
    if (!isOnCommandLine(option, program)) continue;
    if (option.placeholder().empty()) {
      description.add_options()(name.c_str(), optionHelp(option).c_str());
    } else {
      addWithValue(description, name, option.placeholder(),
                   option.key == kMethodKey ? "method that the frames should have [any]"
                                            : optionHelp(option));
    }
  }
  auto add = description.add_options();
  for (const Switch& one : switchesOf(program)) add(one.name.c_str(), one.help.c_str());
  add("help,h", "show this help");
  return description;
}

std::string helpText(const ProgramText& program, const po::options_description& description) {
  std::ostringstream options;
  options << description;
  return fmt::format(
      "{}\n\nUsage: {} {} [options]\nExample: {} {}\n\nMethods: {}\n\n{}\nExit status: {}\n",
      program.purpose, program.name, program.arguments, program.name, program.example,
      knownMethodNames(), options.str(), program.exit_status);
}

bool has(const std::vector<po::option>& given, std::string_view name) {
  return std::any_of(given.begin(), given.end(),
                     [&](const po::option& option) { return option.string_key == name; });
}

bool isMethod(const std::string& text) {
  const auto& methods = methodTable();
  return std::any_of(methods.begin(), methods.end(),
                     [&](const Method& method) { return isSameName(method.name, text); });
}

/// Returns the arguments that do not belong to an option.
/// \throws InputError for an option in the notation of ROS or without dashes: _frames:=5, frames=5
std::vector<std::string> positionals(const std::vector<po::option>& given,
                                     const OptionSet& options) {
  std::vector<std::string> texts;
  for (const po::option& argument : given) {
    if (!argument.string_key.empty()) continue;
    const std::string& text = argument.value.front();
    texts.push_back(text);
    const std::size_t sign = text.find('=');
    if (sign == std::string::npos) continue;
    for (const Option& option : options.options()) {
      if (!isSameName(option.key, text.substr(0, sign))) continue;
      throw InputError(fmt::format("{}: write --{} {}", inQuotes(text), optionName(option.key),
                                   onOneLine(text.substr(sign + 1))));
    }
  }
  return texts;
}

/// Sets METHOD and FILE, which is short for --particles FILE.
void setPositional(const std::vector<std::string>& texts, const std::vector<po::option>& given,
                   const ProgramText& program, OptionSet& options) {
  if (texts.empty()) return;
  if (texts.size() == 2 && !isMethod(texts[0]) && isMethod(texts[1])) {
    throw InputError(fmt::format("{}: METHOD comes first: {} {} {}", inQuotes(texts[1]),
                                 program.name, texts[1], onOneLine(texts[0])));
  }
  options.set(options.find(kMethodKey, ""), texts[0], "METHOD");
  for (std::size_t i = 1; i < texts.size(); ++i) {
    if (isMethod(texts[i])) {
      throw InputError(fmt::format("{}: give only one METHOD", inQuotes(texts[i])));
    }
    if (i > 1 || has(given, "particles")) {
      throw InputError(fmt::format("{}: give only one particle file", inQuotes(texts[i])));
    }
    options.set(options.find("particles", ""), texts[i], "FILE");
  }
}

void checkFolders(const std::vector<std::string>& folders, const ProgramText& program) {
  if (folders.empty()) {
    throw InputError(fmt::format("a folder is missing; try: {} {} (--help lists the options)",
                                 program.name, program.example));
  }
  for (const std::string& folder : folders) {
    if (folder.empty()) throw InputError("DIR: must be a folder, got ''");
  }
}

void setOptions(const std::vector<po::option>& given, OptionSet& options) {
  for (const po::option& argument : given) {
    for (const Option& option : options.options()) {
      if (optionName(option.key) != argument.string_key) continue;
      options.set(option, argument.value.empty() ? "true" : argument.value.front(),
                  "--" + argument.string_key);
    }
  }
}

/// \returns the path of the file; empty: none
std::string readConfig(const std::vector<po::option>& given, OptionSet& options) {
  for (const po::option& option : given) {
    if (option.string_key != "config") continue;
    const std::string& path = option.value.front();
    if (path.empty()) throw InputError("--config: must be a file, got ''");
    parseOptions(readTextFile(path), path, options);
    return path;
  }
  return "";
}

}  // namespace

void refuseUnused(const OptionSet& options, const Scenario& scenario) {
  const auto dashed = [](std::string_view name) { return "--" + optionName(name); };
  for (const std::string_view key : unusedKeys(scenario, options)) {
    if (options.placeOf(key) != dashed(key)) continue;
    throw InputError(fmt::format("{}: {}", dashed(key), whyUnused(scenario.method, dashed)));
  }
}

std::vector<po::option> splitArguments(int argc, const char* const* argv,
                                       const po::options_description& description) {
  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  namespace style = po::command_line_style;
  try {
    std::vector<po::option> options = po::command_line_parser(arguments)
                                          .options(description)
                                          .style(style::unix_style & ~style::allow_guessing)
                                          .run()
                                          .options;
    std::set<std::string> given;
    for (const po::option& option : options) {
      const std::vector<std::string>& tokens = option.original_tokens;
      if (option.string_key.empty()) continue;
      if (!given.insert(option.string_key).second)
        throw InputError(fmt::format("--{}: is given twice", option.string_key));
      if (tokens.size() < 2 || tokens[1].rfind("--", 0) != 0) continue;
      throw InputError(fmt::format("--{}: needs a value, see --help", option.string_key));
    }
    return options;
  } catch (const po::unknown_option& error) {
    throw InputError(unknownOption(error.get_option_name(), description));
  } catch (const po::invalid_command_line_syntax& error) {
    const std::string name = error.get_option_name();
    const std::size_t begin = name.find_first_not_of('-');
    const po::option_description* const option =
        begin < name.size() ? description.find_nothrow(name.substr(begin), false) : nullptr;
    if (option == nullptr) throw InputError(unknownOption(name, description));
    const bool takes_value = option->semantic()->max_tokens() > 0;
    throw InputError(
        fmt::format("{}: {} value, see --help", name, takes_value ? "needs a" : "takes no"));
  } catch (const po::error& error) {
    throw InputError(fmt::format("{}, see --help", error.what()));
  }
}

std::string optionHelp(const Option& option) {
  std::string help(option.meaning);
  if (!option.users().empty()) help += fmt::format("; {}", option.users());
  if (option.placeholder().empty()) return help;
  const std::string value = option.text();
  return fmt::format("{} [{}{}{}]", help, value.empty() ? "none" : value,
                     option.unit.empty() ? "" : " ", option.unit);
}

Switches parseCommandLine(int argc, const char* const* argv, const ProgramText& program,
                          OptionSet& options, const Scenario& scenario) {
  const po::options_description description = describe(options, program);
  const std::vector<po::option> given = splitArguments(argc, argv, description);
  if (has(given, "help")) return {helpText(program, description)};
  Switches switches;
  for (const Switch& one : switchesOf(program)) {
    if (!has(given, one.name)) continue;
    if (one.answer) return {one.answer()};
    switches.given.insert(one.name);
  }
  switches.config = readConfig(given, options);
  const std::vector<std::string> texts = positionals(given, options);
  if (program.takesFolders()) {
    checkFolders(texts, program);
    switches.folders = texts;
  } else {
    setPositional(texts, given, program, options);
  }
  setOptions(given, options);
  const bool knows_method = program.takesFolders() || options.isGiven(kMethodKey) ||
                            (!program.method_from.empty() && options.isGiven(program.method_from));
  if (!knows_method) {
    throw InputError(fmt::format("METHOD is missing; try: {} {} (--help lists the options)",
                                 program.name, program.example));
  }
  checkScenario(scenario);
  if (options.isGiven(kMethodKey)) refuseUnused(options, scenario);
  return switches;
}

}  // namespace spring_pendulum
