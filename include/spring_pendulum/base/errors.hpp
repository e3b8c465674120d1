// The two kinds of errors. Each message is one line: what is wrong, where, and what would be right.
#pragma once

#include <stdexcept>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Wrong use or bad input: a value out of its range, a malformed line, an unknown name. Exit
/// status 2.
class InputError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// A file or folder that could not be read or written. Exit status 1.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
