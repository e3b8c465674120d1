#include "io/files/posix.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <system_error>

namespace spring_pendulum {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& reason = messageForErrno()) {
  throw FileError(fmt::format("{}: could not be read: {}", fullPath(path), reason));
}

}  // namespace

std::string fullPath(const std::string& path) {
  std::error_code error;
  const std::filesystem::path full = std::filesystem::absolute(path, error);
  if (error) return path;
  std::string normal = full.lexically_normal().string();
  if (normal.size() > 1 && normal.back() == '/') normal.pop_back();
  if (path.find("..") == std::string::npos) return normal;
  return std::filesystem::equivalent(full, normal, error) ? normal : full.string();
}

std::string messageForErrno() {
  return std::generic_category().message(errno);
}

std::string followLinks(const std::string& path) {
  constexpr int kMostLinks = 40;  // the limit of Linux
  std::filesystem::path target(path);
  std::error_code error;
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(target, error); ++i)
    target = target.parent_path() / std::filesystem::read_symlink(target, error);
  return target.string();
}

FileDescriptor openTextFile(const std::string& path, std::int64_t& size) {
  // Without O_NONBLOCK, opening a pipe without a writer would block.
  FileDescriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!file.isOpen()) refuse(path);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) refuse(path);
  if (S_ISDIR(status.st_mode)) refuse(path, "it is a folder; give a file");
  if (!S_ISREG(status.st_mode)) refuse(path, "it is a pipe or a device; give a regular file");
  size = status.st_size;
  return file;
}

std::string readTextFile(const std::string& path, std::size_t most) {
  std::int64_t size = 0;
  const FileDescriptor file = openTextFile(path, size);
  // One byte more than the size: a short read then proves the end of the file.
  std::string text(std::min(static_cast<std::size_t>(size) + 1, most), '\0');
  std::size_t length = 0;
  for (;;) {
    const ssize_t count = ::read(file.get(), text.data() + length, text.size() - length);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse(path);
    length += static_cast<std::size_t>(count);
    if (count == 0 || length == most) break;
    if (length == text.size()) text.resize(2 * length);
  }
  text.resize(length);
  if (text.compare(0, 3, "\xEF\xBB\xBF") == 0) text.erase(0, 3);  // the byte order mark
  return text;
}

}  // namespace spring_pendulum
