// The command line of sweep.
#pragma once

#include <cstdint>
#include <string>

#include "sweep/sweep_run.hpp"

namespace spring_pendulum::sweep {

struct CommandLine {
  std::string answer;  ///< text to print instead of a sweep: --help, --version
  std::string study;
  std::int64_t only_case = -1;  ///< negative: all
  SweepOptions options;         ///< with --case, `output` is the folder of the frames; empty: none
};

/// \throws InputError
CommandLine parseCommandLine(int argc, const char* const* argv);

}  // namespace spring_pendulum::sweep
