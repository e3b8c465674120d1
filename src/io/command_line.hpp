// The command line of every program: METHOD, an option `--time-step X` for each key of a table, and
// the switches that all programs share.
#pragma once

#include "simulation/option_set.hpp"
#include <spring_pendulum/simulation/scenario.hpp>

#include <string>

namespace spring_pendulum {

/// What --help and the messages say about a program.
struct ProgramText {
  std::string name;     ///< "Exercise3"
  std::string purpose;  ///< one sentence
  std::string example;  ///< arguments of a typical run
};

/// What the shared switches ask for.
struct Switches {
  bool check = false;         ///< validate the input, print the stability advice, write nothing
  bool report_skips = false;  ///< print what the run leaves out
  std::string answer;         ///< text to print instead of a run: --help, --version, --list-methods
  std::string config;         ///< the file given with --config, empty if none was
};

/// Sets `options` from the file given with --config and then from the other arguments, which win.
/// \param argv    the name of the program and its arguments
/// \param options `scenarioOptions(scenario)` and what the program has besides
/// \throws InputError, and FileError for --config
Switches parseCommandLine(int argc, const char* const* argv, const ProgramText& program,
                          OptionSet& options, const Scenario& scenario);

}  // namespace spring_pendulum
