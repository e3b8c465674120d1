// Exit status and message of a program that fails.
#pragma once

#include <exception>
#include <string>

namespace spring_pendulum {

enum ExitStatus { kDone = 0, kFileFailed = 1, kBadInput = 2, kDiverged = 3, kSignalled = 128 };

struct Failure {
  std::string message;  ///< always one line
  ExitStatus status;
};

/// Returns kBadInput for an InputError, kFileFailed for all other exceptions.
Failure failureOf(const std::exception& error);

}  // namespace spring_pendulum
