#include "io/files/frame_folder_reader.hpp"

#include "base/numbers.hpp"
#include "io/files/paths.hpp"
#include "io/files/text_file.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

namespace spring_pendulum {
namespace {

namespace fs = std::filesystem;

/// Larger folders would not fit into the memory of a small computer as numbers.
constexpr std::uintmax_t kMostBytes = 1'000'000'000;

/// NNNN of frame_NNNN.txt; nothing for other names.
std::optional<std::int64_t> indexOf(std::string_view name) {
  constexpr std::string_view kBegin = "frame_";
  constexpr std::string_view kEnd = ".txt";
  if (name.size() <= kBegin.size() + kEnd.size()) return std::nullopt;
  if (name.substr(0, kBegin.size()) != kBegin) return std::nullopt;
  if (name.substr(name.size() - kEnd.size()) != kEnd) return std::nullopt;
  name = name.substr(kBegin.size(), name.size() - kBegin.size() - kEnd.size());
  if (name.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  return parseInteger(name);
}

[[noreturn]] void refuse(const std::string& folder, const std::string& reason) {
  throw FileError(fmt::format("{}: {}", fullPath(folder), reason));
}

}  // namespace

std::vector<FrameText> readFrameFolder(const std::string& folder) {
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  if (error) refuse(folder, "could not be read: " + error.message());
  std::vector<FrameText> frames;
  std::uintmax_t bytes = 0;
  for (; entries != fs::directory_iterator(); entries.increment(error)) {
    const fs::path path = entries->path();
    const std::optional<std::int64_t> index = indexOf(path.filename().string());
    if (!index) continue;
    frames.push_back({*index, path.string(), ""});
    std::error_code without_size;
    const std::uintmax_t size = fs::file_size(path, without_size);
    if (!without_size) bytes += size;
  }
  if (error) refuse(folder, "could not be read: " + error.message());
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
