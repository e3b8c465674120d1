#include "base/checks.hpp"
#include "base/numbers.hpp"
#include "base/stopwatch.hpp"
#include "io/files/frame_folder.hpp"
#include "io/files/touched_files.hpp"
#include <spring_pendulum/io/frame_writer.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace spring_pendulum {
namespace {

constexpr std::size_t kLongestLine = 2 * (kLongestNumber + 1);
constexpr Eigen::Index kLinesAtOnce = 4096;

}  // namespace

FrameWriter::FrameWriter(const std::string& folder, std::int64_t frames,
                         const std::vector<std::string>& inputs, std::int64_t first)
    : frames_(frames), folder_([&] {
        requireAtLeastZero("frames", frames);
        const Stopwatch stopwatch(seconds_);
        checkTouchedFiles({inputs, {}, folder});
        return std::make_unique<FrameFolder>(folder, frames, first);
      }()) {}

FrameWriter::FrameWriter(FrameWriter&&) noexcept = default;
FrameWriter::~FrameWriter() = default;

FrameFolder& FrameWriter::frameFolder() const {
  if (!folder_) throw InputError("the frame writer was moved from");
  return *folder_;
}

const std::string& FrameWriter::folder() const {
  return frameFolder().path();
}

std::int64_t FrameWriter::earlierFrames() const {
  return frameFolder().earlierFrames();
}

void FrameWriter::write(std::int64_t index, const State& state) {
  const Stopwatch stopwatch(seconds_);
  FrameFolder& folder = frameFolder();
  if (!folder.isOpen()) throw InputError("the frame writer has finished");
  if (index < 0 || index >= frames_) {
    throw InputError(fmt::format("frame {}: must be 0 to {}", index, frames_ - 1));
  }
  const Eigen::Index size = state.size();
  const double* const x = state.x().data();
  const double* const y = state.y().data();
  text_.resize(static_cast<std::size_t>(std::min(size, kLinesAtOnce)) * kLongestLine);
  folder.beginFrame(index);
  for (Eigen::Index first = 0; first < size; first += kLinesAtOnce) {
    char* end = text_.data();
    for (Eigen::Index i = first; i < std::min(size, first + kLinesAtOnce); ++i) {
      end = writeLine({x[i], y[i]}, end);
    }
    folder.write(text_.data(), static_cast<std::size_t>(end - text_.data()));
  }
  folder.endFrame();
}

void FrameWriter::finish() {
  const Stopwatch stopwatch(seconds_);
  if (frameFolder().isOpen()) folder_->close();
}

}  // namespace spring_pendulum
