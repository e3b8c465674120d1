#include "io/files/text_file.hpp"

#include "io/files/paths.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstddef>
#include <fcntl.h>
#include <sys/stat.h>

namespace spring_pendulum {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw FileError(fmt::format("{}: could not be read: {}", fullPath(path), reason));
}

[[noreturn]] void refuseForErrno(const std::string& path) {
  refuse(path, messageForErrno());
}

}  // namespace

FileDescriptor openTextFile(const std::string& path, std::int64_t& size) {
  // Without O_NONBLOCK, opening a pipe without a writer would block.
  FileDescriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!file.isOpen()) refuseForErrno(path);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) refuseForErrno(path);
  if (S_ISDIR(status.st_mode)) refuse(path, "it is a folder; give a file");
  if (!S_ISREG(status.st_mode)) refuse(path, "it is a pipe or a device; give a regular file");
  size = status.st_size;
  return file;
}

std::string readTextFile(const std::string& path) {
  std::int64_t size = 0;
  const FileDescriptor file = openTextFile(path, size);
  // One byte more than the size: a short read then proves the end of the file.
  std::string text(static_cast<std::size_t>(size) + 1, '\0');
  std::size_t length = 0;
  for (;;) {
    const ssize_t count = ::read(file.get(), text.data() + length, text.size() - length);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuseForErrno(path);
    if (count == 0) break;
    length += static_cast<std::size_t>(count);
    if (length == text.size()) text.resize(2 * length);
  }
  text.resize(length);
  if (text.compare(0, kByteOrderMark.size(), kByteOrderMark) == 0) {
    text.erase(0, kByteOrderMark.size());
  }
  return text;
}

}  // namespace spring_pendulum
