#include "io/files/frame_folder.hpp"

#include "base/numbers.hpp"
#include "io/files/posix.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <fcntl.h>
#include <filesystem>
#include <system_error>
#include <unistd.h>

namespace spring_pendulum {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBegin = "frame_";
constexpr std::string_view kEnd = ".txt";
/// Larger folders would not fit into the memory of a small computer as numbers.
constexpr std::uintmax_t kMostBytes = 1'000'000'000;

/// Returns the index of a frame file: its name is `frame_` + at least `digits` digits + `.txt`.
std::optional<std::int64_t> frameIndex(std::string_view name, std::size_t digits = 4) {
  if (name.size() < kBegin.size() + digits + kEnd.size()) return std::nullopt;
  if (name.substr(0, kBegin.size()) != kBegin) return std::nullopt;
  if (name.substr(name.size() - kEnd.size()) != kEnd) return std::nullopt;
  name = name.substr(kBegin.size(), name.size() - kBegin.size() - kEnd.size());
  if (name.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  return parseInteger(name);
}

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw FileError(fmt::format("{}: {}", path, reason));
}

/// Returns the names in a folder, in any order.
std::vector<std::string> namesIn(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (const fs::directory_iterator end; !error && entry != end;) {
    names.push_back(entry->path().filename().string());
    entry.increment(error);
  }
  if (error) refuse(fullPath(folder), "could not be read: " + error.message());
  return names;
}

}  // namespace

std::string frameName(std::int64_t index) {
  return fmt::format("frame_{:04}.txt", index);
}

bool isFrameName(const std::string& name) {
  const std::size_t around = hiddenName("").size();
  const std::string frame = name.size() > around ? name.substr(1, name.size() - around) : "";
  return frameIndex(name) || (name == hiddenName(frame) && frameIndex(frame));
}

std::int64_t removeFrames(const OutputFolder& folder, std::int64_t first) {
  std::vector<std::string> earlier;
  std::int64_t count = 0;
  for (const std::string& name : namesIn(folder.path())) {
    const std::optional<std::int64_t> index = frameIndex(name);
    if (!isFrameName(name) || index.value_or(first) < first) continue;
    struct stat status {};
    if (::fstatat(folder.descriptor(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0 ||
        !S_ISREG(status.st_mode))
      refuse(folder.path() + "/" + name,
             "has the name of a frame file but is not a regular file; remove it");
    // Those of other users first: if one cannot be removed, none is.
    earlier.insert(status.st_uid == ::geteuid() ? earlier.end() : earlier.begin(), name);
    count += index ? 1 : 0;
  }
  for (const std::string& name : earlier) {
    if (::unlinkat(folder.descriptor(), name.c_str(), 0) == 0) continue;
    refuse(folder.path() + "/" + name, "could not be removed: " + messageForErrno());
  }
  return count;
}

std::vector<FrameText> readFrameFolder(const std::string& folder) {
  std::vector<FrameText> frames;
  std::uintmax_t bytes = 0;
  for (const std::string& name : namesIn(folder)) {
    const std::optional<std::int64_t> index = frameIndex(name, 1);
    if (!index) continue;
    const fs::path path = fs::path(folder) / name;
    frames.push_back({*index, path.string(), ""});
    std::error_code without_size;
    const std::uintmax_t size = fs::file_size(path, without_size);
    if (!without_size) bytes += size;
  }
  if (frames.empty()) refuse(fullPath(folder), "has no frames frame_0000.txt, frame_0001.txt, ...");
  if (bytes > kMostBytes)
    refuse(fullPath(folder),
           fmt::format("its frames have {} MB, more than the {} MB that can be compared",
                       bytes / 1'000'000, kMostBytes / 1'000'000));
  std::sort(frames.begin(), frames.end(),
            [](const FrameText& a, const FrameText& b) { return a.index < b.index; });
  for (FrameText& frame : frames) frame.text = readTextFile(frame.name);
  return frames;
}

}  // namespace spring_pendulum
