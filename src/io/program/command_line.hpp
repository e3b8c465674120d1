// The command line of all programs: METHOD, the particle file, an option such as `--time-step X` for
// each key of the option table, and switches.
#pragma once

#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/simulation/scenario.hpp>

#include <boost/program_options/option.hpp>
#include <boost/program_options/options_description.hpp>

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {

/// An option without a value.
struct Switch {
  std::string name;
  std::string help;
  std::function<std::string()> answer = {};  ///< text to print instead of a run; empty: none
};

/// Texts about a program for --help and messages.
struct ProgramText {
  std::string name;     ///< "Exercise3"
  std::string purpose;  ///< one sentence
  std::string example;  ///< arguments of a typical run
  std::vector<Switch> switches = {
      {"check", "try the run, report verdict, errors and the largest step sizes; write nothing"}};
  std::string arguments = "METHOD [FILE]";
  std::string exit_status =
      "0 done, 1 could not read or write, 2 wrong use or bad input,\n"
      "3 the motion diverged, 128 + n stopped by signal n.";
  /// For a program that takes folders and --method instead of METHOD and FILE: the keys of its
  /// options. It can read configuration files with other keys.
  std::vector<std::string_view> keys = {};

  /// Key of an option whose file tells the method, so that METHOD may be missing; empty: none.
  std::string_view method_from = {};

  bool takesFolders() const { return !keys.empty(); }
};

/// What is given on a command line, in addition to the options.
struct Switches {
  std::string answer;                     ///< text to print instead of a run
  std::string config = {};                ///< file given with --config; empty: none
  std::vector<std::string> folders = {};  ///< of a program that takes folders
  std::set<std::string> given = {};

  bool has(const std::string& name) const { return given.count(name) > 0; }
};

/// Sets `options` from the file given with --config and then from the other arguments, which win.
/// \param argv    the name of the program and its arguments
/// \param options `scenarioOptions(scenario)` and other options of the program
/// \throws InputError, and FileError for --config
Switches parseCommandLine(int argc, const char* const* argv, const ProgramText& program,
                          OptionSet& options, const Scenario& scenario);

/// On the command line, unlike in a file, an option that the method does not use is an error.
/// \throws InputError
void refuseUnused(const OptionSet& options, const Scenario& scenario);

/// Returns the arguments in their order; one without a name is positional.
/// \param argv the name of the program and its arguments
/// \throws InputError for an unknown option, with the one that was probably meant, or a missing value
std::vector<boost::program_options::option> splitArguments(
    int argc, const char* const* argv,
    const boost::program_options::options_description& description);

/// Returns the meaning of an option with its default in brackets, for the help text.
std::string optionHelp(const Option& option);

}  // namespace spring_pendulum
