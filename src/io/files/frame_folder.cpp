#include "io/files/frame_folder.hpp"

#include "base/numbers.hpp"
#include "io/files/paths.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace spring_pendulum {
namespace {

constexpr std::string_view kBegin = "frame_";
constexpr std::string_view kEnd = ".txt";

}  // namespace

std::string frameName(std::int64_t index) {
  return fmt::format("frame_{:04}.txt", index);
}

std::optional<std::int64_t> frameIndex(std::string_view name, std::size_t digits) {
  if (name.size() < kBegin.size() + digits + kEnd.size()) return std::nullopt;
  if (name.substr(0, kBegin.size()) != kBegin) return std::nullopt;
  if (name.substr(name.size() - kEnd.size()) != kEnd) return std::nullopt;
  name = name.substr(kBegin.size(), name.size() - kBegin.size() - kEnd.size());
  if (name.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  return parseInteger(name);
}

bool isFrameName(const std::string& name) {
  const std::size_t around = hiddenName("").size();
  if (frameIndex(name)) return true;
  if (name.size() < around) return false;
  const std::string frame = name.substr(1, name.size() - around);
  return name == hiddenName(frame) && frameIndex(frame);
}

FrameFolder::FrameFolder(const std::string& folder, std::int64_t first)
    : folder_(folder), lock_(folder_, kFramesLock, path(), AtomicFile::Lock::kEmpty) {
  removeEarlier(first);
}

void FrameFolder::removeEarlier(std::int64_t first) {
  std::vector<std::string> earlier;
  const auto refuse = [this](const std::string& name, const std::string& reason) {
    throw FileError(fmt::format("{}/{}: {}", path(), name, reason));
  };
  for (const std::string& name : namesIn(path())) {
    const std::optional<std::int64_t> index = frameIndex(name);
    if (!isFrameName(name) || index.value_or(first) < first) continue;
    struct stat status {};
    if (::fstatat(folder_.descriptor(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0 ||
        !S_ISREG(status.st_mode)) {
      refuse(name, "has the name of a frame file but is not a regular file; remove it");
    }
    earlier.push_back(name);
    earlier_frames_ += index ? 1 : 0;
  }
  for (const std::string& name : earlier) {
    if (::unlinkat(folder_.descriptor(), name.c_str(), 0) == 0) continue;
    refuse(name, "could not be removed: " + messageForErrno());
  }
}

void FrameFolder::close() {
  lock_.discard();
  folder_.checkPath();
}

AtomicFile FrameFolder::begin(std::int64_t index) const {
  const std::string name = frameName(index);
  return {folder_, name, path() + "/" + name, AtomicFile::Lock::kNone};
}

}  // namespace spring_pendulum
