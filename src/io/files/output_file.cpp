#include "io/files/output_file.hpp"

#include "io/files/frame_folder.hpp"
#include "io/files/posix.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace spring_pendulum {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kPermissions = 0666;  // reduced by the umask
constexpr std::size_t kBufferSize = 1 << 16;

/// Returns the path behind symbolic links.
/// \throws InputError, FileError if an output must not be written there
std::string targetOf(const std::string& path) {
  std::string target = followLinks(path);
  const std::string name = fs::path(target).filename().string();
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (!exists && errno != ENOENT)
    throw FileError(fmt::format("{}: could not be written: {}", fullPath(path), messageForErrno()));
  if (name.empty() || (exists && !S_ISREG(status.st_mode)))
    throw FileError(fullPath(path) + ": is a folder, a pipe or a device; give a regular file");
  if (isFrameName(name))
    throw InputError(fullPath(path) + ": is the name of a frame file; give another name");
  if (exists && ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0)
    throw FileError(fmt::format("{}: could not be written: {}", fullPath(path), messageForErrno()));
  return target;
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path) : given_path_(path), path_(fullPath(path)) {
  std::error_code error, ignored;
  fs::create_directories(path, error);
  // For a link that leads nowhere, older standard libraries report that it is not a folder.
  const bool leads_nowhere = fs::is_symlink(path, ignored) && !fs::exists(path, ignored);
  if (error == std::errc::file_exists || (error && leads_nowhere))
    throw FileError(path_ + ": could not be created: it is a link to a folder that does not exist");
  if (error == std::errc::not_a_directory)
    throw FileError(path_ + ": could not be created: it is a file or lies in one; give a folder");
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
  } while (lock != Lock::kNone && !takeLock());
}

void AtomicFile::open(int flags) {
  file_ =
      FileDescriptor(::openat(folder_.descriptor(), hidden_.c_str(),
                              O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC | flags, kPermissions));
  if (file_.isOpen()) return;
  const std::string reason = messageForErrno();
  struct stat taken {};
  if (::fstatat(folder_.descriptor(), hidden_.c_str(), &taken, AT_SYMLINK_NOFOLLOW) == 0)
    refuseTaken();
  refuse("could not be written: " + reason);
}

bool AtomicFile::takeLock() {
  // That a file system has no locks is not an error.
  if (::flock(file_.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    refuse("another run is writing here; use a different path for each run");
  struct stat opened = {}, by_name = {};
  if (::fstat(file_.get(), &opened) != 0) refuseForErrno();
  if (!S_ISREG(opened.st_mode) || opened.st_nlink > 1) refuseTaken();
  const bool has_its_name =
      ::fstatat(folder_.descriptor(), hidden_.c_str(), &by_name, AT_SYMLINK_NOFOLLOW) == 0 &&
      isSameFile(by_name, opened);
  if (!has_its_name) return false;
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
      ::renameat(folder, hidden_.c_str(), folder, name_.c_str()) != 0)
    refuseForErrno();
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

OutputFile::OutputFile(const std::string& path)
    : target_(targetOf(path)),
      folder_((fs::path(".") / target_).parent_path().string()),
      file_(folder_, fs::path(target_).filename().string(), fullPath(path),
            AtomicFile::Lock::kOneWriter) {
  struct stat earlier = {}, folder = {};
  const bool exists = ::stat(target_.c_str(), &earlier) == 0;
  ::fstat(folder_.descriptor(), &folder);
  const uid_t user = ::geteuid();  // in a sticky folder, rename() replaces own files only
  const bool is_own = user == 0 || user == earlier.st_uid || user == folder.st_uid;
  if (exists && !is_own && (folder.st_mode & S_ISVTX) != 0)
    file_.refuse("belongs to another user, so it can't be replaced in this folder");
  if (exists) ::fchmod(file_.descriptor(), earlier.st_mode & 0777U);  // not all file systems can
}

void OutputFile::write(std::string_view text) {
  text_ += text;
  if (text_.size() >= kBufferSize) flush();
}

void OutputFile::flush() {
  file_.write(text_);
  text_.clear();
}

bool OutputFile::copyEarlier() {
  std::error_code error;
  fs::copy_file(target_, unfinishedPath(), fs::copy_options::overwrite_existing, error);
  if (error && error != std::errc::no_such_file_or_directory)
    file_.refuse("could not be copied: " + error.message());
  return !error;
}

std::string OutputFile::earlierText(std::size_t most) const {
  const bool is_missing = ::access(target_.c_str(), F_OK) != 0 && errno == ENOENT;
  return is_missing ? "" : readTextFile(target_, most);
}

std::string OutputFile::unfinishedPath() {
  flush();
  return fmt::format("/proc/self/fd/{}", file_.descriptor());
}

std::uintmax_t OutputFile::size() const {
  struct stat status {};
  if (::fstat(file_.descriptor(), &status) != 0) file_.refuseForErrno();
  return static_cast<std::uintmax_t>(status.st_size);
}

void OutputFile::finish() {
  flush();
  file_.finish();
  folder_.checkPath();
}

}  // namespace spring_pendulum
