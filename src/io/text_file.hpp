// Whole text files in memory, and pieces of them quoted in error messages.
#pragma once

#include <string>
#include <string_view>

namespace spring_pendulum {

/// The bytes of a regular file without a leading UTF-8 byte order mark. Never waits: a pipe or a
/// device is refused.
/// \throws FileError naming the file and why it could not be read
std::string readTextFile(const std::string& path);

/// Foreign text with '?' for each control character.
std::string onOneLine(std::string_view text);

/// A piece of foreign text, fit for a message of one line: quoted, without control characters, and
/// cut short if it is long.
std::string quoted(std::string_view text);

}  // namespace spring_pendulum
