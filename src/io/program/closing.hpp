// What a program prints before and after a run.
#pragma once

#include <spring_pendulum/simulation/run.hpp>

#include <string>

namespace spring_pendulum {

/// Returns a line with a warning; empty if there is none.
std::string warningLine(const std::string& warning);

/// Prints one line to standard output, before anything that is printed to standard error later.
/// \throws FileError if it can't be written
void printClosingLine(const std::string& text);

/// Prints what --check asks for. \returns the exit status of the program
int printAdvice(const Run& run);

/// Returns lines for standard error: a remark if the run needs much memory, a warning if its step size
/// is too large.
std::string startLines(const Run& run);

/// Prints the warnings on a run that has ended, or its divergence with a remedy.
/// \returns the exit status of the program
int conclude(const Run& run);

}  // namespace spring_pendulum
