// The command line of Exercise3: METHOD and an option for each parameter of the table, its key with
// dashes (`--time-step 0.01`), or all of them from a YAML file with --config.
#pragma once

#include <spring_pendulum/simulation/scenario.hpp>

#include <string>

namespace spring_pendulum {

/// What a command line asks for.
struct CommandLine {
  Scenario scenario;   ///< the run, if `answer` is empty
  bool check = false;  ///< only validate the input and print the stability advice
  std::string answer;  ///< the text to print instead of a run: --help, --version, --list-methods
  bool report_skips = false;  ///< whether the run is to say what it leaves out
};

/// The command line wins over the file given with --config.
/// \throws InputError, and FileError for --config
CommandLine parseCommandLine(int argc, const char* const* argv);

}  // namespace spring_pendulum
