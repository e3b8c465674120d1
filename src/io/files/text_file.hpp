// Reading text files, and quoting their text in error messages.
#pragma once

#include <string>
#include <string_view>

namespace spring_pendulum {

/// Returns the bytes of a regular file without a leading UTF-8 byte order mark. Refuses pipes and
/// devices, so it never blocks.
/// \throws FileError with the file and the reason
std::string readTextFile(const std::string& path);

/// Returns text with '?' for each control character.
std::string onOneLine(std::string_view text);

/// Returns text in quotes for a message of one line: without control characters, truncated if long.
std::string quoted(std::string_view text);

}  // namespace spring_pendulum
