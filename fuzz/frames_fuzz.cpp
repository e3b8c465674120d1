// Arbitrary files give frames that can be compared, and a report, or an error of one line. A line
// `@NAME` of the input begins the next file.
#include "check/checker.hpp"
#include "check/motion.hpp"
#include "io/files/frame_folder.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

#include "fuzz_target.hpp"

namespace {

using namespace spring_pendulum;
namespace fs = std::filesystem;

/// The same for all inputs of a process.
const fs::path& folder() {
  static const fs::path kFolder =
      fs::temp_directory_path() / ("frames_fuzz_" + std::to_string(getpid()));
  return kFolder;
}

void writeFiles(std::string_view input) {
  std::ofstream file;
  while (!input.empty()) {
    const std::size_t end = std::min(input.find('\n'), input.size() - 1) + 1;
    const std::string_view line = input.substr(0, end);
    if (line.front() != '@') {
      file << line;
    } else {
      const std::string name(line.substr(1, line.find_last_not_of('\n')));
      const bool is_file = name.find_first_of(std::string("/\0", 2)) == std::string::npos;
      file = is_file ? std::ofstream(folder() / name, std::ios::binary) : std::ofstream();
    }
    input.remove_prefix(end);
  }
}

Scene threeParticles() {
  Scene particles{Eigen::Vector3d(1, 1, 2), State(3)};
  particles.state.x() << 0, 1, 2;
  particles.state.y() << 0, 0, 0.5;
  return particles;
}

void checkNumbers(const AllFrames& all, std::ptrdiff_t particles) {
  require(!all.frames.empty() && all.digits >= 0, "frames");
  std::int64_t index = -1;
  for (const FrameNumbers& frame : all.frames) {
    require(frame.index > index, "frames by increasing index");
    index = frame.index;
    require(frame.positions.rows() == particles, "all particles");
    require(frame.units.allFinite() && (frame.units >= 0.0).all(), "units of the last digit");
  }
}

bool isOneLine(const std::string& text) {
  return !text.empty() && text.find_first_of("\r\n\t") == std::string::npos;
}

void checkReport(const std::vector<FrameText>& frames, const Scene& particles) {
  int questions = 0;  // a whole search takes seconds
  const FrameCheck check = checkFrames(Scenario(), particles, frames, true, [&] {
    constexpr int kMostQuestions = 30;
    return ++questions > kMostQuestions;
  });
  constexpr const char* kResults[] = {"equal", "undecided", "different"};
  const char* const result = kResults[static_cast<int>(check.verdict)];
  require(check.lines.front().rfind(result, 0) == 0, "a result");
  for (const std::string& line : check.lines) require(isOneLine(line), "a line of the report");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Scene kParticles = threeParticles();
  fs::create_directory(folder());
  writeFiles({reinterpret_cast<const char*>(data), size});
  try {
    const std::vector<FrameText> frames = readFrameFolder(folder().string());
    checkNumbers(readFrames(frames, kParticles), kParticles.state.size());
    checkReport(frames, kParticles);
  } catch (const FileError& error) {
    require(isOneLine(error.what()), "a message of one line");
  }
  fs::remove_all(folder());
  return 0;
}
