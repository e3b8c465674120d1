#include "io/files/frame_folder.hpp"

#include "io/files/paths.hpp"
#include <spring_pendulum/base/errors.hpp>

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

/// A file that shows whether the folder is writable. With five zeros, it is not a frame's name.
constexpr const char* kTrial = ".frame_00000.tmp";

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

/// "frame_0042.txt" to ".frame_0042.tmp"
std::string hiddenFrom(const std::string& frame) {
  return "." + frame.substr(0, frame.size() - 4) + ".tmp";
}

/// Shorter names first, so that names are in the order of their numbers.
bool isLater(const std::string& a, const std::string& b) {
  return a.size() != b.size() ? a.size() > b.size() : a > b;
}

}  // namespace

std::string frameName(std::int64_t index) {
  return fmt::format("frame_{:04}.txt", index);
}

bool isFrameName(std::string_view name) {
  return isFrame(name) || isHidden(name);
}

FrameFolder::FrameFolder(const std::string& folder, std::int64_t frames, std::int64_t first)
    : given_path_(folder), path_(fullPath(folder)) {
  open();
  const std::vector<std::string> earlier = listOwnFiles(first);
  tryOut();
  takeAway(earlier, frames - first);
}

FrameFolder::~FrameFolder() {
  removeHidden();
}

void FrameFolder::open() {
  std::error_code error;
  std::filesystem::create_directories(given_path_, error);
  // For a link that leads nowhere, older standard libraries report that it is not a folder.
  std::error_code ignored;
  const bool leads_nowhere = std::filesystem::is_symlink(given_path_, ignored) &&
                             !std::filesystem::exists(given_path_, ignored);
  if (error == std::errc::file_exists || (error && leads_nowhere)) {
    throw FileError(path_ + ": could not be created: it is a link to a folder that does not exist");
  }
  if (error == std::errc::not_a_directory) {
    throw FileError(path_ + ": could not be created: it is a file or lies in one; give a folder");
  }
  if (error) throw FileError(fmt::format("{}: could not be created: {}", path_, error.message()));
  descriptor_ = FileDescriptor(::open(given_path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!descriptor_.isOpen()) {
    throw FileError(fmt::format("{}: could not be opened: {}", path_, messageForErrno()));
  }
  // The lock ends with the descriptor, however the program ends. A file system without locks is not
  // an error.
  const bool is_locked = ::flock(descriptor_.get(), LOCK_EX | LOCK_NB) == 0;
  if (!is_locked && errno == EWOULDBLOCK) {
    throw FileError(fmt::format(
        "{}: another run is writing frames here; use a different folder for each run", path_));
  }
}

std::vector<std::string> FrameFolder::listOwnFiles(std::int64_t first) const {
  const std::string first_name = frameName(first);
  const int again = ::openat(descriptor_.get(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const std::unique_ptr<DIR, int (*)(DIR*)> listing(again < 0 ? nullptr : ::fdopendir(again),
                                                    ::closedir);
  if (!listing) refuse("", "could not be read: " + messageForErrno());
  std::vector<std::string> names;
  errno = 0;
  for (const dirent* entry = ::readdir(listing.get()); entry != nullptr;
       errno = 0, entry = ::readdir(listing.get())) {
    const std::string name = entry->d_name;
    if (!isFrameName(name) || (isFrame(name) && isLater(first_name, name))) continue;
    struct stat status {};
    if (::fstatat(descriptor_.get(), entry->d_name, &status, AT_SYMLINK_NOFOLLOW) != 0) {
      if (errno == ENOENT) continue;
      refuse(name, "could not be read: " + messageForErrno());
    }
    if (!S_ISREG(status.st_mode)) {
      refuse(name, "has the name of a frame file but is not a regular file; remove it");
    }
    names.push_back(name);
  }
  if (errno != 0) refuse("", "could not be read: " + messageForErrno());
  return names;
}

/// Creates a file and removes it, before any earlier frame is touched.
void FrameFolder::tryOut() {
  const int folder = descriptor_.get();
  ::unlinkat(folder, kTrial, 0);  // left by a killed run
  UnfinishedFile trial(folder, kTrial);
  if (!trial.create() || ::fstat(trial.descriptor(), &fresh_) != 0) {
    throw FileError(fmt::format("{}: could not be written: {}", path_, messageForErrno()));
  }
  trial.remove();
}

void FrameFolder::takeAway(const std::vector<std::string>& earlier, std::int64_t frames) {
  const int folder = descriptor_.get();
  std::vector<std::string> hidden_frames;
  for (const std::string& name : earlier) {
    if (!isFrame(name)) {
      old_files_.push_back(name);
      continue;
    }
    const std::string hidden = hiddenFrom(name);
    if (::renameat(folder, name.c_str(), folder, hidden.c_str()) != 0) {
      const std::string reason = messageForErrno();
      for (const std::string& frame : hidden_frames) {
        ::renameat(folder, hiddenFrom(frame).c_str(), folder, frame.c_str());
      }
      old_files_.clear();
      refuse(name, fmt::format("could not be removed: {}", reason));
    }
    hidden_frames.push_back(name);
    old_files_.push_back(hidden);
  }
  earlier_frames_ = static_cast<std::int64_t>(hidden_frames.size());
  std::sort(old_files_.begin(), old_files_.end(), isLater);
  const auto last = std::unique(old_files_.begin(), old_files_.end());
  old_files_.erase(last, old_files_.end());
  const std::size_t wanted = std::min(old_files_.size(), static_cast<std::size_t>(frames));
  const auto first_wanted = old_files_.end() - static_cast<std::ptrdiff_t>(wanted);
  for (auto name = old_files_.begin(); name != first_wanted; ++name) {
    ::unlinkat(folder, name->c_str(), 0);
  }
  old_files_.erase(old_files_.begin(), first_wanted);
}

/// Opens an old file, which keeps its length for now, or creates a new one.
bool FrameFolder::openHidden(std::int64_t index) {
  while (!old_files_.empty()) {
    file_ = UnfinishedFile(descriptor_.get(), old_files_.back());
    old_files_.pop_back();
    if (file_.reuse(fresh_)) return true;
    ::unlinkat(descriptor_.get(), file_.name().c_str(), 0);
  }
  file_ = UnfinishedFile(descriptor_.get(), hiddenFrom(frameName(index)));
  return file_.create();
}

void FrameFolder::beginFrame(std::int64_t index) {
  assert(descriptor_.isOpen());
  frame_name_ = frameName(index);
  if (!openHidden(index)) refuseForErrno(frame_name_);
}

void FrameFolder::write(const char* data, std::size_t size) {
  if (!file_.write(data, size)) refuseForErrno(frame_name_);
}

void FrameFolder::endFrame() {
  if (!file_.appearAs(frame_name_)) refuseForErrno(frame_name_);
}

void FrameFolder::endFrame(std::int64_t length) {
  file_.setLength(length);
  endFrame();
}

void FrameFolder::removeHidden() {
  if (!descriptor_.isOpen()) return;
  file_.remove();
  for (const std::string& name : old_files_) ::unlinkat(descriptor_.get(), name.c_str(), 0);
  old_files_.clear();
}

void FrameFolder::close() {
  removeHidden();
  if (!leadsTo(given_path_, descriptor_.get())) {
    refuse("", "was moved or removed during the run, and the frames with it");
  }
  descriptor_.close();
}

void FrameFolder::refuse(const std::string& name, const std::string& reason) const {
  throw FileError(fmt::format("{}{}{}: {}", path_, name.empty() ? "" : "/", name, reason));
}

void FrameFolder::refuseForErrno(const std::string& name) const {
  refuse(name, fmt::format("could not be written: {}", messageForErrno()));
}

}  // namespace spring_pendulum
