// Reading text files.
#pragma once

#include <string>

namespace spring_pendulum {

/// Returns the bytes of a regular file without a leading UTF-8 byte order mark. Refuses pipes and
/// devices, so it never blocks.
/// \throws FileError with the file and the reason
std::string readTextFile(const std::string& path);

}  // namespace spring_pendulum
