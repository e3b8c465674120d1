#include "io/files/unfinished_file.hpp"

#include "io/files/paths.hpp"

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <sys/stat.h>

namespace spring_pendulum {
namespace {

constexpr mode_t kPermissions = 0666;  // reduced by the umask

}  // namespace

bool UnfinishedFile::create() {
  file_ = FileDescriptor(::openat(
      folder_, name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kPermissions));
  reused_ = false;
  length_ = 0;
  return file_.isOpen();
}

bool UnfinishedFile::open() {
  file_ = FileDescriptor(
      ::openat(folder_, name_.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  reused_ = true;
  length_ = 0;
  return file_.isOpen();
}

bool UnfinishedFile::reuse(const struct stat& fresh) {
  if (!open()) return false;
  struct stat status {};
  const bool is_like_new = ::fstat(file_.get(), &status) == 0 && status.st_nlink == 1 &&
                           status.st_mode == fresh.st_mode && status.st_uid == fresh.st_uid &&
                           status.st_gid == fresh.st_gid;
  if (!is_like_new) file_.close();
  return is_like_new;
}

bool UnfinishedFile::hasItsName() const {
  struct stat by_name {};
  struct stat opened {};
  return ::fstatat(folder_, name_.c_str(), &by_name, AT_SYMLINK_NOFOLLOW) == 0 &&
         ::fstat(file_.get(), &opened) == 0 && isSameFile(by_name, opened);
}

bool UnfinishedFile::write(const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t count = ::write(file_.get(), data, size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    data += count;
    size -= static_cast<std::size_t>(count);
    length_ += count;
  }
  return true;
}

bool UnfinishedFile::appearAs(const std::string& name) {
  if (reused_) {
    struct stat status {};
    if (::fstat(file_.get(), &status) != 0) return false;
    if (status.st_size != length_ && ::ftruncate(file_.get(), length_) != 0) return false;
  }
  // Closing a duplicate reports write errors of a network file system and keeps the lock.
  FileDescriptor copy(::fcntl(file_.get(), F_DUPFD_CLOEXEC, 0));
  if (!copy.isOpen() || !copy.close()) return false;
  if (::renameat(folder_, name_.c_str(), folder_, name.c_str()) != 0) return false;
  file_.close();
  return true;
}

void UnfinishedFile::remove() {
  if (!isOpen()) return;
  if (hasItsName()) ::unlinkat(folder_, name_.c_str(), 0);
  file_.close();
}

}  // namespace spring_pendulum
