// What a run has to tell. Every program says the same, before and after.
#pragma once

#include <spring_pendulum/simulation/run.hpp>

#include <functional>
#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// What a program says before a run.
struct Remarks {
  std::vector<std::string> notes;  ///< much memory is needed, gravity points up
  std::string warning;             ///< the step size is too large; empty if it is not
};

Remarks remarksOn(const Run& run);

/// What a program says after a run.
struct Outcome {
  int status = 0;  ///< exit status of the program: 0, or 3 if the motion has diverged
  /// Warnings; after a divergence one line instead: when, where, a remedy.
  std::vector<std::string> lines;
};

/// \param stop asked while a remedy for a divergence is sought; when it returns true, there is none
Outcome outcomeOf(const Run& run, const std::function<bool()>& stop = {});

}  // namespace spring_pendulum
#pragma GCC visibility pop
