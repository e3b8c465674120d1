// How the programs end, and what they say when they fail.
#pragma once

#include <exception>
#include <string>

namespace spring_pendulum {

enum ExitStatus { kDone = 0, kFileFailed = 1, kBadInput = 2, kDiverged = 3, kSignalled = 128 };

struct Failure {
  std::string message;  ///< one line, whatever foreign text is in it
  ExitStatus status;
};

/// kBadInput for an InputError, kFileFailed for all else.
Failure failureOf(const std::exception& error);

}  // namespace spring_pendulum
