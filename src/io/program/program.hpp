// How a program begins and ends: standard streams that may be closed, full or gone; signals; exit
// status; what it prints before and after a run.
#pragma once

#include <spring_pendulum/simulation/run.hpp>

#include <exception>
#include <functional>
#include <string>
#include <string_view>

namespace spring_pendulum {

enum ExitStatus { kDone = 0, kFileFailed = 1, kBadInput = 2, kDiverged = 3, kSignalled = 128 };

struct Failure {
  std::string message;  ///< always one line
  ExitStatus status;
};

/// Returns kBadInput for an InputError, kFileFailed for all other exceptions.
Failure failureOf(const std::exception& error);

/// Runs a program: prepares the process, flushes the output, and reports a failure.
///
/// Opens standard streams that are closed: otherwise a file of the run would get the number of such a
/// stream and receive its messages. Writing to such a stream still fails. Also ignores SIGPIPE and
/// SIGXFSZ, so that `write` reports a closed pipe or a file size limit as an error.
/// \param report gets the message of a failure; by default, it is a line on standard error
/// \returns the exit status of the program or of its failure
int runProgram(const std::function<int()>& program,
               const std::function<void(const std::string&)>& report = {});

/// Prints to standard output. \throws FileError if it can't be written
void printOutput(std::string_view text);
/// Flushes standard output. \throws FileError if it can't be written
void flushOutput();

/// Prints to standard error. Never fails: a run must not end because its messages can't be printed.
void printError(std::string_view text) noexcept;

/// From this call on, the first SIGINT, SIGTERM or SIGHUP is only recorded, so that it ends a run between
/// two steps. One that follows within half a second is the same again: `timeout` and a closing terminal
/// signal a process twice. A later one ends the program. An ignored signal, as under nohup, stays so.
/// \param also called in the signal handler, so it must be async-signal-safe; null: nothing
void catchInterruptions(void (*also)() = nullptr);

/// Returns the number of the recorded signal, 0 if there was none.
int interruption();

/// Returns a line with a warning; empty if there is none.
std::string warningLine(const std::string& warning);

/// Prints one line to standard output, before anything that is printed to standard error later.
/// \throws FileError if it can't be written
void printClosingLine(const std::string& text);

/// Prints what --check asks for. \returns the exit status of the program
int printAdvice(const Run& run);

/// Returns lines for standard error: that the run needs much memory, that its step size is too large.
std::string startLines(const Run& run);

/// Prints the warnings on a run that has ended, or its divergence with a remedy, and returns the exit status.
int conclude(const Run& run);

}  // namespace spring_pendulum
