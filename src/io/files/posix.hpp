// Files of the operating system: paths for error messages, identity, descriptors, reading text.
#pragma once

#include <cstdint>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

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

/// Owns and closes a POSIX file descriptor; -1: none.
class FileDescriptor {
 public:
  explicit FileDescriptor(int descriptor = -1) : descriptor_(descriptor) {}
  ~FileDescriptor() { close(); }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  FileDescriptor(FileDescriptor&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }

  bool isOpen() const { return descriptor_ >= 0; }
  int get() const { return descriptor_; }

  /// \returns false with errno set if buffered data could not be written
  bool close() { return descriptor_ < 0 || ::close(std::exchange(descriptor_, -1)) == 0; }

 private:
  int descriptor_;
};

/// Opens a regular file for reading. Refuses pipes and devices, so it never blocks.
/// \param size set to the size of the file, bytes
/// \throws FileError with the file and the reason
FileDescriptor openTextFile(const std::string& path, std::int64_t& size);

/// Returns the first bytes of a file, opened in this way, without a leading UTF-8 byte order mark.
/// \throws FileError with the file and the reason
std::string readTextFile(const std::string& path, std::size_t most = std::string::npos);

}  // namespace spring_pendulum
