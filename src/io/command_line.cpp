#include "io/command_line.hpp"

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/io/scenario_file.hpp>
#include <spring_pendulum/model/errors.hpp>
#include <spring_pendulum/simulation/parameters.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <variant>

namespace spring_pendulum {
namespace {

constexpr std::string_view kMethodKey = "method";
constexpr const char* kConfigOption = "--config";
constexpr const char* kListMethodsOption = "--list-methods";
constexpr const char* kCheckOption = "--check";
constexpr const char* kReportSkipsOption = "--report-skips";

std::string optionFor(const Parameter& parameter) {
  std::string name = fmt::format("--{}", parameter.key);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

bool isFlag(const Parameter& parameter) {
  return std::holds_alternative<bool Scenario::*>(parameter.member);
}

std::string placeholderFor(const Parameter& parameter) {
  if (std::holds_alternative<double Scenario::*>(parameter.member)) return "X";
  if (std::holds_alternative<std::int64_t Scenario::*>(parameter.member)) return "N";
  return parameter.key == "output" ? "DIR" : "FILE";
}

std::string helpFor(const Parameter& parameter) {
  if (parameter.key == kMethodKey) {
    return fmt::format("{}: {}", parameter.meaning, knownMethodNames());
  }
  std::string help(parameter.meaning);
  if (parameter.applies_to == AppliesTo::kFixedStep) help += "; fixed-step methods";
  if (parameter.applies_to == AppliesTo::kErrorControlled) help += "; error-controlled methods";
  if (isFlag(parameter)) return help;
  return fmt::format("{} [{}{}{}]", help, formatValue(parameter, Scenario{}),
                     parameter.unit.empty() ? "" : " ", parameter.unit);
}

std::string listOfMethods() {
  std::string list;
  for (const Method& method : methodTable()) {
    list += fmt::format("{:<20} order {}, {} stage{}, {}\n{:<20} {}\n", method.name, method.order,
                        method.stages, method.stages == 1 ? "" : "s",
                        method.control == StepControl::kFixed ? "fixed step" : "error-controlled",
                        "", method.use);
  }
  return list;
}

/// A CLI11 application with an option for each parameter, and what was given to them.
class Parser {
 public:
  Parser() {
    app_.allow_extras();
    app_.option_defaults()->take_last();  // so that a script can be given options to overrule
    app_.get_formatter()->column_width(30);
    app_.set_help_flag("--help,-h", "show this help");
    app_.set_version_flag("--version", "spring_pendulum " SPRING_PENDULUM_VERSION,
                          "show the version");
    app_.add_flag(kListMethodsOption, list_methods_, "list the methods");
    app_.add_flag(kCheckOption, check_,
                  "validate the input, print the stability advice, integrate nothing");
    app_.add_flag(kReportSkipsOption, report_skips_, "print what the run leaves out as not needed");
    app_.add_option(kConfigOption, config_, "YAML file with the same names; the command line wins")
        ->type_name("FILE");
    for (const Parameter& parameter : parameterTable()) addOption(parameter);
  }

  CommandLine parse(int argc, const char* const* argv) {
    try {
      app_.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
      return {{}, false, app_.help()};
    } catch (const CLI::CallForVersion& version) {
      return {{}, false, fmt::format("{}\n", version.what())};
    } catch (const CLI::ParseError& error) {
      throw InputError(fmt::format("{}, see --help", error.what()));
    }
    if (list_methods_) return {{}, false, listOfMethods()};
    refuseExtras();
    return {scenario(), check_, "", report_skips_};
  }

 private:
  struct Given {
    CLI::Option* option = nullptr;
    std::string text;
  };

  void addOption(const Parameter& parameter) {
    Given& given = given_[parameter.key];
    const std::string name = optionFor(parameter);
    const std::string help = helpFor(parameter);
    if (parameter.key == kMethodKey) {
      given.option = app_.add_option("METHOD", given.text, help)->type_name("");
    } else if (isFlag(parameter)) {
      given.option = app_.add_flag(name, given.text, help);
    } else {
      given.option = app_.add_option(name, given.text, help)->type_name(placeholderFor(parameter));
    }
  }

  void refuseExtras() const {
    std::vector<std::string> extras = app_.remaining();
    extras.erase(std::remove(extras.begin(), extras.end(), "--"), extras.end());
    if (extras.empty()) return;
    if (extras.front().substr(0, 1) != "-") {
      throw InputError(
          fmt::format("unexpected argument '{}': a METHOD and options are known, see "
                      "--help",
                      extras.front()));
    }
    std::string known = fmt::format("{}, {}, {}, {}, --help, --version", kConfigOption,
                                    kListMethodsOption, kCheckOption, kReportSkipsOption);
    for (const Parameter& parameter : parameterTable()) {
      if (parameter.key != kMethodKey) known += ", " + optionFor(parameter);
    }
    throw InputError(fmt::format("unknown option '{}': known are {}", extras.front(), known));
  }

  Scenario scenario() const {
    ScenarioBuilder builder;
    if (app_.count(kConfigOption) > 0) {
      if (config_.empty()) throw InputError("--config: config is '': must be a file");
      readScenarioFile(config_, builder);
    }
    for (const Parameter& parameter : parameterTable()) {
      const Given& given = given_.at(parameter.key);
      if (given.option->count() == 0) continue;
      builder.set(parameter.key, given.text, given.option->get_name());
    }
    if (!builder.isGiven(kMethodKey)) {
      throw InputError(fmt::format("METHOD is missing: known are {}", knownMethodNames()));
    }
    return builder.build();
  }

  CLI::App app_{
      "Integrates the motion of a chain of particles and damped springs and writes its "
      "frames.\nExit status: 0 done, 1 could not read or write, 2 wrong use or bad "
      "input, 3 the motion diverged.",
      "Exercise3"};
  std::string config_;
  bool list_methods_ = false;
  bool check_ = false;
  bool report_skips_ = false;
  std::map<std::string_view, Given> given_;  ///< by key
};

}  // namespace

CommandLine parseCommandLine(int argc, const char* const* argv) {
  return Parser().parse(argc, argv);
}

}  // namespace spring_pendulum
