// Reading text files.
#pragma once

#include "io/files/file_descriptor.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace spring_pendulum {

/// A text file may start with it.
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Opens a regular file for reading. Refuses pipes and devices, so it never blocks.
/// \param size set to the size of the file, bytes
/// \throws FileError with the file and the reason
FileDescriptor openTextFile(const std::string& path, std::int64_t& size);

/// Returns the bytes of a file, opened in this way, without a leading UTF-8 byte order mark.
/// \throws FileError with the file and the reason
std::string readTextFile(const std::string& path);

}  // namespace spring_pendulum
