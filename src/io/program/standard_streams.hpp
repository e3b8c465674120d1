// Standard input, output and error, which may be closed, full or gone.
#pragma once

#include <string_view>

namespace spring_pendulum {

/// Prepares the process; every program calls it first. Opens standard streams that are closed:
/// otherwise a file of the run would get the number of such a stream and receive its messages.
/// Writing to such a stream still fails. Also ignores SIGPIPE and SIGXFSZ, so that `write` reports
/// a closed pipe or a file size limit as an error.
void prepareProcess();

/// Prints to standard output. \throws FileError if it can't be written
void printOutput(std::string_view text);
/// Flushes standard output. \throws FileError if it can't be written
void flushOutput();

/// Prints to standard error. Never fails: a run must not end because its messages can't be printed.
void printError(std::string_view text) noexcept;

}  // namespace spring_pendulum
