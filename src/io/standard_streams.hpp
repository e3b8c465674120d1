// Standard input, output and error, which may be closed, full or gone.
#pragma once

#include <string_view>

namespace spring_pendulum {

/// To be called first in every program: whatever is closed of standard input, output and error is
/// opened, so that no file of the run gets its number and a message lands in it. What is written
/// there fails, as it would without.
/// A reader that has gone away and a file that is larger than allowed become errors of `write`.
void prepareProcess();

/// Prints to standard output. \throws FileError if it can't be written
void printOutput(std::string_view text);
/// Brings to standard output what has been printed. \throws FileError if it can't be written
void flushOutput();

/// Prints to standard error. Never fails: a run does not end because nobody reads its messages.
void printError(std::string_view text) noexcept;

}  // namespace spring_pendulum
