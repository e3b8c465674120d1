#include "io/files/output_file.hpp"

#include "io/files/frame_folder.hpp"
#include "io/files/paths.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace spring_pendulum {
namespace {

namespace fs = std::filesystem;

/// Returns the path behind symbolic links.
/// \throws InputError, FileError if an output must not be written there
std::string targetOf(const std::string& path) {
  std::string target = followLinks(path);
  const std::string name = fs::path(target).filename().string();
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (!exists && errno != ENOENT) {
    throw FileError(fmt::format("{}: could not be written: {}", fullPath(path), messageForErrno()));
  }
  if (name.empty() || (exists && !S_ISREG(status.st_mode))) {
    throw FileError(fullPath(path) + ": is a folder, a pipe or a device; give a regular file");
  }
  if (isFrameName(name)) {
    throw InputError(fullPath(path) + ": is the name of a frame file; give another name");
  }
  if (exists && ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) {
    throw FileError(fmt::format("{}: could not be written: {}", fullPath(path), messageForErrno()));
  }
  return target;
}

std::string folderOf(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

}  // namespace

OutputFile::OutputFile(const std::string& path)
    : path_(fullPath(path)),
      target_(targetOf(path)),
      folder_(folderOf(target_)),
      file_(folder_, fs::path(target_).filename().string(), path_, AtomicFile::Lock::kOneWriter) {
  struct stat earlier {};
  const bool exists = ::stat(target_.c_str(), &earlier) == 0;
  if (exists) ::fchmod(file_.descriptor(), earlier.st_mode & 0777U);  // not all file systems can
}

bool OutputFile::copyEarlier() {
  std::error_code error;
  fs::copy_file(target_, unfinishedPath(), fs::copy_options::overwrite_existing, error);
  if (error && error != std::errc::no_such_file_or_directory) {
    file_.refuse("could not be copied: " + error.message());
  }
  return !error;
}

std::string OutputFile::unfinishedPath() const {
  return fmt::format("/proc/self/fd/{}", file_.descriptor());
}

std::uintmax_t OutputFile::size() const {
  struct stat status {};
  if (::fstat(file_.descriptor(), &status) != 0) file_.refuseForErrno();
  return static_cast<std::uintmax_t>(status.st_size);
}

void OutputFile::finish() {
  file_.finish();
  folder_.checkPath();
}

}  // namespace spring_pendulum
