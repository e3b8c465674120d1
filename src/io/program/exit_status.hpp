// The exit status of programs, and the common part of their main functions.
#pragma once

#include <exception>
#include <functional>
#include <string>

namespace spring_pendulum {

enum ExitStatus { kDone = 0, kFileFailed = 1, kBadInput = 2, kDiverged = 3, kSignalled = 128 };

struct Failure {
  std::string message;  ///< always one line
  ExitStatus status;
};

/// Returns kBadInput for an InputError, kFileFailed for all other exceptions.
Failure failureOf(const std::exception& error);

/// Runs a program: flushes its output and reports its failure.
/// \param report gets the message of a failure; by default, it is a line on standard error
/// \returns the exit status of the program or of its failure
int runProgram(const std::function<int()>& program,
               const std::function<void(const std::string&)>& report = {});

}  // namespace spring_pendulum
