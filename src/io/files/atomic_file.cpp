#include "io/files/atomic_file.hpp"

#include "io/files/paths.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>
#include <utility>

namespace spring_pendulum {
namespace {

constexpr mode_t kPermissions = 0666;  // reduced by the umask

}  // namespace

OutputFolder::OutputFolder(const std::string& path) : given_path_(path), path_(fullPath(path)) {
  std::error_code error, ignored;
  std::filesystem::create_directories(path, error);
  // For a link that leads nowhere, older standard libraries report that it is not a folder.
  const bool leads_nowhere =
      std::filesystem::is_symlink(path, ignored) && !std::filesystem::exists(path, ignored);
  if (error == std::errc::file_exists || (error && leads_nowhere)) {
    throw FileError(path_ + ": could not be created: it is a link to a folder that does not exist");
  }
  if (error == std::errc::not_a_directory) {
    throw FileError(path_ + ": could not be created: it is a file or lies in one; give a folder");
  }
  if (error) throw FileError(fmt::format("{}: could not be created: {}", path_, error.message()));
  descriptor_ = FileDescriptor(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (descriptor_.isOpen()) return;
  throw FileError(fmt::format("{}: could not be opened: {}", path_, messageForErrno()));
}

void OutputFolder::checkPath() const {
  struct stat by_path {};
  struct stat opened {};
  const bool leads_here = ::stat(given_path_.c_str(), &by_path) == 0 &&
                          ::fstat(descriptor_.get(), &opened) == 0 && isSameFile(by_path, opened);
  if (leads_here) return;
  throw FileError(path_ + ": was moved or removed during the run, and its files with it");
}

std::string hiddenName(const std::string& name) {
  return "." + name + ".tmp";
}

AtomicFile::AtomicFile(const OutputFolder& folder, std::string name, std::string path, Lock lock)
    : folder_(folder), name_(std::move(name)), hidden_(hiddenName(name_)), path_(std::move(path)) {
  do {
    open(lock == Lock::kNone ? O_EXCL : O_NONBLOCK);
  } while (lock != Lock::kNone && !takeLock(lock));
}

void AtomicFile::open(int flags) {
  file_ =
      FileDescriptor(::openat(folder_.descriptor(), hidden_.c_str(),
                              O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC | flags, kPermissions));
  if (file_.isOpen()) return;
  const std::string reason = messageForErrno();
  struct stat taken {};
  if (::fstatat(folder_.descriptor(), hidden_.c_str(), &taken, AT_SYMLINK_NOFOLLOW) == 0) {
    refuseTaken();
  }
  refuse("could not be written: " + reason);
}

bool AtomicFile::takeLock(Lock lock) {
  if (::flock(file_.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    refuse("another run is writing here; use a different path for each run");
  }  // a file system without locks is not an error
  struct stat opened {};
  struct stat by_name {};
  if (::fstat(file_.get(), &opened) != 0) refuseForErrno();
  if (!S_ISREG(opened.st_mode) || opened.st_nlink > 1) refuseTaken();
  const bool has_its_name =
      ::fstatat(folder_.descriptor(), hidden_.c_str(), &by_name, AT_SYMLINK_NOFOLLOW) == 0 &&
      isSameFile(by_name, opened);
  if (!has_its_name) return false;
  if (opened.st_size > 0 && lock == Lock::kEmpty) refuseTaken();
  if (opened.st_size > 0 && ::ftruncate(file_.get(), 0) != 0) refuseForErrno();
  return true;
}

void AtomicFile::discard() {
  if (file_.isOpen()) ::unlinkat(folder_.descriptor(), hidden_.c_str(), 0);
  file_.close();
}

void AtomicFile::write(std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(file_.get(), text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuseForErrno();
    text.remove_prefix(static_cast<std::size_t>(count));
  }
}

void AtomicFile::finish() {
  // Closing a duplicate reports write errors of a network file system and keeps the lock.
  FileDescriptor copy(::fcntl(file_.get(), F_DUPFD_CLOEXEC, 0));
  const int folder = folder_.descriptor();
  if (!copy.isOpen() || !copy.close() ||
      ::renameat(folder, hidden_.c_str(), folder, name_.c_str()) != 0) {
    refuseForErrno();
  }
  file_.close();
}

void AtomicFile::refuse(const std::string& reason) const {
  throw FileError(fmt::format("{}: {}", path_, reason));
}

void AtomicFile::refuseTaken() const {
  refuse(fmt::format("needs the name {}, which is taken; remove that file", hidden_));
}

void AtomicFile::refuseForErrno() const {
  refuse("could not be written: " + messageForErrno());
}

}  // namespace spring_pendulum
