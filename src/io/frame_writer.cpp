#include <spring_pendulum/io/frame_writer.hpp>
#include <spring_pendulum/model/errors.hpp>

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <dirent.h>
#include <fcntl.h>
#include <filesystem>
#include <memory>
#include <string_view>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>

namespace spring_pendulum {
namespace {

// A frame is written under this name and then renamed. One name is enough, as the folder is locked;
// what a killed run leaves under it is removed by the next run.
constexpr const char* kUnfinishedName = ".frame.tmp";
// The longest shortest text of a double is -2.2250738585072014e-308.
constexpr std::size_t kLongestNumber = 24;
constexpr std::size_t kLongestLine = 2 * (kLongestNumber + 1);

/// Adds the time it lives to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum) {}
  ~Stopwatch() { sum_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& sum_;
  Clock::time_point start_ = Clock::now();
};

std::string messageForErrno() {
  return std::generic_category().message(errno);
}

bool isFrameName(std::string_view name) {
  constexpr std::string_view kPrefix = "frame_";
  constexpr std::string_view kSuffix = ".txt";
  if (name.size() < kPrefix.size() + 4 + kSuffix.size()) return false;
  if (name.substr(0, kPrefix.size()) != kPrefix) return false;
  if (name.substr(name.size() - kSuffix.size()) != kSuffix) return false;
  name.remove_prefix(kPrefix.size());
  name.remove_suffix(kSuffix.size());
  return std::all_of(name.begin(), name.end(), [](char c) { return '0' <= c && c <= '9'; });
}

}  // namespace

std::string frameName(std::int64_t index) {
  return fmt::format(FMT_COMPILE("frame_{:04}.txt"), index);
}

FrameWriter::FrameWriter(const std::string& folder, std::int64_t frames)
    : folder_(std::filesystem::absolute(folder).lexically_normal().string()), frames_(frames) {
  const Stopwatch stopwatch(seconds_);
  if (folder_.size() > 1 && folder_.back() == '/') folder_.pop_back();
  openFolder();
  checkFolderIsWritable();
  removeEarlierFrames();
}

FrameWriter::~FrameWriter() {
  if (folder_descriptor_.isOpen()) ::unlinkat(folder_descriptor_.get(), kUnfinishedName, 0);
}

void FrameWriter::openFolder() {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw FileError(fmt::format("{}: could not be made: {}", folder_, error.message()));
  folder_descriptor_ = FileDescriptor(::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder_descriptor_.isOpen()) {
    throw FileError(fmt::format("{}: could not be opened: {}", folder_, messageForErrno()));
  }
  // The lock goes with the descriptor, however the program ends. A file system without locks is no
  // reason to refuse.
  const bool locked = ::flock(folder_descriptor_.get(), LOCK_EX | LOCK_NB) == 0;
  if (!locked && errno == EWOULDBLOCK) {
    throw FileError(fmt::format(
        "{}: another run writes its frames here, must be a folder of its own", folder_));
  }
}

void FrameWriter::checkFolderIsWritable() {
  ::unlinkat(folder_descriptor_.get(), kUnfinishedName, 0);
  const FileDescriptor file(::openat(folder_descriptor_.get(), kUnfinishedName,
                                     O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!file.isOpen()) {
    throw FileError(fmt::format("{}: could not be written: {}", folder_, messageForErrno()));
  }
  ::unlinkat(folder_descriptor_.get(), kUnfinishedName, 0);
}

// All of them, also those that this run writes anew: to replace a file costs some file systems far
// more than to remove it and make a fresh one, and what a stopped run leaves must not be a mixture.
void FrameWriter::removeEarlierFrames() {
  const std::unique_ptr<DIR, int (*)(DIR*)> listing(::opendir(folder_.c_str()), ::closedir);
  if (!listing) refuseForErrno("");
  std::vector<std::string> names;
  while (const dirent* entry = ::readdir(listing.get())) {
    if (isFrameName(entry->d_name)) names.emplace_back(entry->d_name);
  }
  for (const std::string& name : names) {
    struct stat status {};
    const int error =
        ::fstatat(folder_descriptor_.get(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW);
    if (error == 0 && !S_ISREG(status.st_mode)) {
      refuse(name, "is in the way of the frames: must be removed first, as it is no regular file");
    }
  }
  for (const std::string& name : names) {
    if (::unlinkat(folder_descriptor_.get(), name.c_str(), 0) != 0 && errno != ENOENT) {
      refuse(name, fmt::format("could not be removed: {}", messageForErrno()));
    }
  }
}

void FrameWriter::write(std::int64_t index, const State& state) {
  assert(folder_descriptor_.isOpen() && 0 <= index && index < frames_);
  const Stopwatch stopwatch(seconds_);
  const auto size = static_cast<std::size_t>(state.size());
  if (text_.size() < size * kLongestLine) text_.resize(size * kLongestLine);
  char* end = text_.data();
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    end = fmt::format_to(end, FMT_COMPILE("{} {}\n"), state.x()[i], state.y()[i]);
  }
  writeFile(frameName(index), text_.data(), static_cast<std::size_t>(end - text_.data()));
}

void FrameWriter::writeFile(const std::string& name, const char* data, std::size_t size) {
  const int folder = folder_descriptor_.get();
  FileDescriptor file(
      ::openat(folder, kUnfinishedName, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (!file.isOpen()) refuseForErrno(name);
  while (size > 0) {
    const ssize_t count = ::write(file.get(), data, size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuseForErrno(name);
    data += count;
    size -= static_cast<std::size_t>(count);
  }
  if (!file.close()) refuseForErrno(name);
  if (::renameat(folder, kUnfinishedName, folder, name.c_str()) != 0) refuseForErrno(name);
}

void FrameWriter::finish() {
  if (!folder_descriptor_.close()) refuseForErrno("");
}

void FrameWriter::refuse(const std::string& name, const std::string& reason) const {
  throw FileError(fmt::format("{}: {}", (std::filesystem::path(folder_) / name).string(), reason));
}

void FrameWriter::refuseForErrno(const std::string& name) const {
  refuse(name, fmt::format("could not be written: {}", messageForErrno()));
}

}  // namespace spring_pendulum
