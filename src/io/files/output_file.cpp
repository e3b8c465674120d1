#include "io/files/output_file.hpp"

#include "io/files/frame_folder.hpp"
#include "io/files/paths.hpp"
#include "io/files/touched_files.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <sys/stat.h>

namespace spring_pendulum {
namespace {

constexpr int kMostAttempts = 10;  // while other runs create and remove the file

/// Throws for an existing file that must not be replaced.
void checkEarlierFile(const std::string& path) {
  struct stat status {};
  const std::string full_path = fullPath(path);
  if (::stat(path.c_str(), &status) != 0) {
    if (errno == ENOENT) return;
    throw FileError(fmt::format("{}: could not be written: {}", full_path, messageForErrno()));
  }
  if (!S_ISREG(status.st_mode)) {
    throw FileError(
        fmt::format("{}: is a folder, a pipe or a device; give a regular file", full_path));
  }
  if (::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) {
    throw FileError(fmt::format("{}: could not be written: {}", full_path, messageForErrno()));
  }
}

}  // namespace

OutputFile::OutputFile(const std::string& path) : path_(fullPath(path)) {
  checkEarlierFile(path);
  const std::filesystem::path target(followLinks(path));
  name_ = target.filename().string();
  folder_path_ = target.has_parent_path() ? target.parent_path().string() : ".";
  if (name_.empty()) throw FileError(fmt::format("{}: is a folder; give a file", path_));
  if (isFrameName(name_)) {
    throw InputError(fmt::format("{}: is the name of a frame file; give another name", path_));
  }
  openFolder();
  createUnfinished();
  keepPermissions();
}

OutputFile::~OutputFile() {
  file_.remove();
}

void OutputFile::openFolder() {
  std::error_code ignored;  // open() reports the folder that is missing
  std::filesystem::create_directories(folder_path_, ignored);
  folder_ = FileDescriptor(::open(folder_path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder_.isOpen()) refuseForErrno();
}

void OutputFile::createUnfinished() {
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    file_ = UnfinishedFile(folder_.get(), name_ + kUnfinished);
    if (file_.create()) {
      // Between creation and lock, another run may take the file for a leftover and remove it.
      if (lock()) return;
    } else if (errno != EEXIST) {
      refuseForErrno();
    } else if (file_.open()) {
      refuseUnlessUnfinished();
      if (lock()) file_.remove();  // left by a killed run
    } else if (errno != ENOENT) {
      refuseUnlessUnfinished();
    }
  }
  refuse("other runs are writing it; use a different file for each run");
}

/// A new FILE gets the permissions of the one that it replaces.
void OutputFile::keepPermissions() {
  struct stat earlier {};
  if (::fstatat(folder_.get(), name_.c_str(), &earlier, 0) != 0) return;
  ::fchmod(file_.descriptor(), earlier.st_mode & 0777U);  // not every file system has permissions
}

/// \returns false if the run that held the lock before has renamed or removed the file
bool OutputFile::lock() {
  if (::flock(file_.descriptor(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    file_ = UnfinishedFile();  // belongs to the other run
    refuse("another run is writing it; use a different file for each run");
  }
  return file_.hasItsName();  // a file system without locks is not an error
}

void OutputFile::refuseUnlessUnfinished() const {
  struct stat status {};
  const int error = ::fstatat(folder_.get(), file_.name().c_str(), &status, AT_SYMLINK_NOFOLLOW);
  if (error == 0 && S_ISREG(status.st_mode) && file_.isOpen()) return;
  if (error != 0 && errno == ENOENT) return;
  const std::string name = (std::filesystem::path(path_).parent_path() / file_.name()).string();
  if (error != 0 || S_ISREG(status.st_mode)) {
    throw FileError(fmt::format("{}: is left over and could not be opened; remove it", name));
  }
  throw FileError(
      fmt::format("{}: is needed for writing but is not a regular file; remove it", name));
}

void OutputFile::write(std::string_view text) {
  if (!file_.write(text.data(), text.size())) refuseForErrno();
}

bool OutputFile::copyEarlier() {
  const FileDescriptor earlier(
      ::openat(folder_.get(), name_.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (!earlier.isOpen() && errno == ENOENT) return false;
  if (!earlier.isOpen()) refuseForErrno();
  std::array<char, 1 << 16> piece{};
  for (;;) {
    const ssize_t count = ::read(earlier.get(), piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse("could not be read: " + messageForErrno());
    if (count == 0) return true;
    write({piece.data(), static_cast<std::size_t>(count)});
  }
}

std::string OutputFile::unfinishedPath() const {
  return fmt::format("/proc/self/fd/{}", file_.descriptor());
}

std::uintmax_t OutputFile::size() const {
  struct stat status {};
  if (::fstat(file_.descriptor(), &status) != 0) refuseForErrno();
  return static_cast<std::uintmax_t>(status.st_size);
}

void OutputFile::finish() {
  if (!file_.hasItsName()) refuse("was replaced or removed by another program during the run");
  if (!file_.appearAs(name_)) refuseForErrno();
  if (!leadsTo(folder_path_, folder_.get())) {
    refuse("its folder was moved or removed during the run, and the file with it");
  }
}

void OutputFile::refuse(const std::string& reason) const {
  throw FileError(fmt::format("{}: {}", path_, reason));
}

void OutputFile::refuseForErrno() const {
  refuse("could not be written: " + messageForErrno());
}

}  // namespace spring_pendulum
