// Paths as error messages show them, and files told apart by what they are instead of their names.
#pragma once

#include <string>
#include <sys/stat.h>
#include <vector>

namespace spring_pendulum {

/// The whole path, without "." and, where no symbolic link is lost by it, without "..".
std::string fullPath(const std::string& path);

/// The text for `errno`: "No such file or directory".
std::string messageForErrno();

/// Whether two names lead to one file or folder.
inline bool isSameFile(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// Whether a path leads to the file or folder that is open as `descriptor`.
bool leadsTo(const std::string& path, int descriptor);

/// Whether a file is one of those that a run reads.
/// \param inputs their paths; empty ones are left out
/// \throws FileError if that can't be found out
bool isInput(const struct stat& file, const std::vector<std::string>& inputs);

}  // namespace spring_pendulum
