// Standard input, output and error, which may be closed, full or gone.
#pragma once

#include <string_view>

namespace spring_pendulum {

/// Must be called first in every program. Opens standard streams that are closed, so that no file
/// of the run gets their number and receives messages. Writing to such a stream still fails.
/// Also ignores SIGPIPE and SIGXFSZ, so that a closed pipe and a file size limit are errors of
/// `write`.
void prepareProcess();

/// Prints to standard output. \throws FileError if it can't be written
void printOutput(std::string_view text);
/// Flushes standard output. \throws FileError if it can't be written
void flushOutput();

/// Prints to standard error. Never fails: a run must not end because its messages can't be printed.
void printError(std::string_view text) noexcept;

}  // namespace spring_pendulum
