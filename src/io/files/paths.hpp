// Paths for error messages, and comparison of files by identity instead of name.
#pragma once

#include <string>
#include <sys/stat.h>
#include <vector>

namespace spring_pendulum {

/// Returns the absolute path without ".". Removes ".." unless that would skip a symbolic link.
std::string fullPath(const std::string& path);

/// The text for `errno`: "No such file or directory".
std::string messageForErrno();

/// Whether two paths lead to the same file or folder.
inline bool isSameFile(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// Returns the path behind all symbolic links, whether the file exists or not.
std::string followLinks(const std::string& path);

/// Returns the names in a folder, in any order.
/// \throws FileError naming the folder if it can't be read
std::vector<std::string> namesIn(const std::string& folder);

}  // namespace spring_pendulum
