#include "io/files/frame_folder_reader.hpp"

#include "io/files/frame_folder.hpp"
#include "io/files/paths.hpp"
#include "io/files/text_file.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <system_error>

namespace spring_pendulum {
namespace {

namespace fs = std::filesystem;

/// Larger folders would not fit into the memory of a small computer as numbers.
constexpr std::uintmax_t kMostBytes = 1'000'000'000;

[[noreturn]] void refuse(const std::string& folder, const std::string& reason) {
  throw FileError(fmt::format("{}: {}", fullPath(folder), reason));
}

}  // namespace

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
  if (frames.empty()) refuse(folder, "has no frames frame_0000.txt, frame_0001.txt, ...");
  if (bytes > kMostBytes) {
    refuse(folder, fmt::format("its frames have {} MB, more than the {} MB that can be compared",
                               bytes / 1'000'000, kMostBytes / 1'000'000));
  }
  std::sort(frames.begin(), frames.end(),
            [](const FrameText& a, const FrameText& b) { return a.index < b.index; });
  for (FrameText& frame : frames) frame.text = readTextFile(frame.name);
  return frames;
}

}  // namespace spring_pendulum
