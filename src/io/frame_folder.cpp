#include "io/frame_folder.hpp"

#include <spring_pendulum/model/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <dirent.h>
#include <fcntl.h>
#include <filesystem>
#include <memory>
#include <string_view>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>
#include <utility>

namespace spring_pendulum {
namespace {

std::string messageForErrno() {
  return std::generic_category().message(errno);
}

std::string hiddenName(std::int64_t index) {
  return fmt::format(".frame_{:04}.tmp", index);
}

/// Whether a name is `prefix` + at least four digits + `suffix`.
bool isNumbered(std::string_view name, std::string_view prefix, std::string_view suffix) {
  if (name.size() < prefix.size() + 4 + suffix.size()) return false;
  if (name.substr(0, prefix.size()) != prefix) return false;
  if (name.substr(name.size() - suffix.size()) != suffix) return false;
  name.remove_prefix(prefix.size());
  name.remove_suffix(suffix.size());
  return std::all_of(name.begin(), name.end(), [](char c) { return '0' <= c && c <= '9'; });
}

bool isFrame(std::string_view name) {
  return isNumbered(name, "frame_", ".txt");
}

bool isHidden(std::string_view name) {
  return isNumbered(name, ".frame_", ".tmp");
}

/// Shorter names first, so that the numbers in them are in order.
bool isLater(const std::string& a, const std::string& b) {
  return a.size() != b.size() ? a.size() > b.size() : a > b;
}

bool writeAll(int file, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t count = ::write(file, data, size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    data += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

}  // namespace

std::string frameName(std::int64_t index) {
  return fmt::format("frame_{:04}.txt", index);
}

FrameFolder::FrameFolder(const std::string& folder, std::int64_t frames)
    : path_(std::filesystem::absolute(folder).lexically_normal().string()) {
  if (path_.size() > 1 && path_.back() == '/') path_.pop_back();
  open();
  takeEarlierFramesAway(frames);
  checkIsWritable();
}

FrameFolder::~FrameFolder() {
  removeHidden();
}

void FrameFolder::open() {
  std::error_code error;
  std::filesystem::create_directories(path_, error);
  if (error) throw FileError(fmt::format("{}: could not be made: {}", path_, error.message()));
  descriptor_ = FileDescriptor(::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!descriptor_.isOpen()) {
    throw FileError(fmt::format("{}: could not be opened: {}", path_, messageForErrno()));
  }
  // The lock goes with the descriptor, however the program ends. A file system without locks is no
  // reason to refuse.
  const bool is_locked = ::flock(descriptor_.get(), LOCK_EX | LOCK_NB) == 0;
  if (!is_locked && errno == EWOULDBLOCK) {
    throw FileError(
        fmt::format("{}: another run writes its frames here, must be a folder of its own", path_));
  }
}

std::vector<std::string> FrameFolder::listOwnFiles() const {
  const std::unique_ptr<DIR, int (*)(DIR*)> listing(::opendir(path_.c_str()), ::closedir);
  if (!listing) refuseForErrno("");
  std::vector<std::string> names;
  while (const dirent* entry = ::readdir(listing.get())) {
    const std::string name = entry->d_name;
    if (!isFrame(name) && !isHidden(name)) continue;
    struct stat status {};
    const int error = ::fstatat(descriptor_.get(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW);
    if (error == 0 && !S_ISREG(status.st_mode)) {
      refuse(name, "is in the way of the frames: must be removed first, as it is no regular file");
    }
    names.push_back(name);
  }
  return names;
}

void FrameFolder::takeEarlierFramesAway(std::int64_t frames) {
  for (const std::string& name : listOwnFiles()) {
    std::string hidden = name;
    if (isFrame(name)) {
      hidden = "." + name.substr(0, name.size() - 4) + ".tmp";
      if (::renameat(descriptor_.get(), name.c_str(), descriptor_.get(), hidden.c_str()) != 0) {
        refuse(name, fmt::format("could not be removed: {}", messageForErrno()));
      }
    }
    old_files_.push_back(std::move(hidden));
  }
  std::sort(old_files_.begin(), old_files_.end(), isLater);
  const auto last = std::unique(old_files_.begin(), old_files_.end());
  old_files_.erase(last, old_files_.end());
  const std::size_t wanted = std::min(old_files_.size(), static_cast<std::size_t>(frames));
  const auto first_wanted = old_files_.end() - static_cast<std::ptrdiff_t>(wanted);
  for (auto name = old_files_.begin(); name != first_wanted; ++name) {
    ::unlinkat(descriptor_.get(), name->c_str(), 0);
  }
  old_files_.erase(old_files_.begin(), first_wanted);
}

void FrameFolder::checkIsWritable() {
  if (!openHidden(0).isOpen()) {
    throw FileError(fmt::format("{}: could not be written: {}", path_, messageForErrno()));
  }
  old_files_.push_back(std::move(hidden_name_));  // the first to be written
  hidden_name_.clear();
}

/// An old file, still as long as it was, or a new one.
FileDescriptor FrameFolder::openHidden(std::int64_t index) {
  const int folder = descriptor_.get();
  while (!old_files_.empty()) {
    hidden_name_ = old_files_.back();
    old_files_.pop_back();
    FileDescriptor file(::openat(folder, hidden_name_.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC));
    struct stat status {};
    // With a second name elsewhere it is not ours alone.
    if (file.isOpen() && ::fstat(file.get(), &status) == 0 && status.st_nlink == 1) return file;
    ::unlinkat(folder, hidden_name_.c_str(), 0);
  }
  hidden_name_ = hiddenName(index);
  return FileDescriptor(
      ::openat(folder, hidden_name_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
}

void FrameFolder::beginFrame(std::int64_t index) {
  assert(descriptor_.isOpen());
  frame_name_ = frameName(index);
  length_ = 0;
  file_ = openHidden(index);
  if (!file_.isOpen()) refuseForErrno(frame_name_);
}

void FrameFolder::write(const char* data, std::size_t size) {
  if (!writeAll(file_.get(), data, size)) refuseForErrno(frame_name_);
  length_ += static_cast<std::int64_t>(size);
}

void FrameFolder::endFrame() {
  struct stat status {};
  const int file = file_.get();
  if (::fstat(file, &status) != 0) refuseForErrno(frame_name_);
  if (status.st_size != length_ && ::ftruncate(file, length_) != 0) refuseForErrno(frame_name_);
  if (!file_.close()) refuseForErrno(frame_name_);
  const int folder = descriptor_.get();
  if (::renameat(folder, hidden_name_.c_str(), folder, frame_name_.c_str()) != 0) {
    refuseForErrno(frame_name_);
  }
  hidden_name_.clear();
}

void FrameFolder::removeHidden() {
  if (!descriptor_.isOpen()) return;
  if (!hidden_name_.empty()) old_files_.push_back(std::move(hidden_name_));
  hidden_name_.clear();
  for (const std::string& name : old_files_) ::unlinkat(descriptor_.get(), name.c_str(), 0);
  old_files_.clear();
}

void FrameFolder::close() {
  removeHidden();
  if (!descriptor_.close()) refuseForErrno("");
}

void FrameFolder::refuse(const std::string& name, const std::string& reason) const {
  throw FileError(fmt::format("{}: {}", (std::filesystem::path(path_) / name).string(), reason));
}

void FrameFolder::refuseForErrno(const std::string& name) const {
  refuse(name, fmt::format("could not be written: {}", messageForErrno()));
}

}  // namespace spring_pendulum
