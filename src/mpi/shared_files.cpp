#include "mpi/shared_files.hpp"

#include "base/numbers.hpp"
#include "base/stopwatch.hpp"
#include "io/files/file_descriptor.hpp"
#include "io/files/paths.hpp"
#include "io/files/touched_files.hpp"
#include "io/formats/run_files.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <fcntl.h>
#include <limits>
#include <unistd.h>

namespace spring_pendulum {
namespace {

[[noreturn]] void refuseForErrno(const std::string& path) {
  throw FileError(fmt::format("{}: could not be written: {}", path, messageForErrno()));
}

void writeAt(const std::string& path, std::int64_t offset, const std::string& text) {
  FileDescriptor file(::open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC));
  if (!file.isOpen()) refuseForErrno(path);
  for (std::size_t written = 0; written < text.size();) {
    const ssize_t count = ::pwrite(file.get(), text.data() + written, text.size() - written,
                                   offset + static_cast<off_t>(written));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuseForErrno(path);
    written += static_cast<std::size_t>(count);
  }
  if (!file.close()) refuseForErrno(path);
}

/// Writes the lines `x y` of the rows of a rank to `text`.
void formatFrame(const ChainPart& part, std::string& text) {
  const State& state = part.state();
  const std::ptrdiff_t first = part.firstRow();
  text.resize(static_cast<std::size_t>(state.size() - first) * 2 * (kLongestNumber + 1));
  char* end = text.data();
  for (Eigen::Index i = first; i < state.size(); ++i) {
    end = writeLine({state.x()[i], state.y()[i]}, end);
  }
  text.resize(static_cast<std::size_t>(end - text.data()));
}

}  // namespace

SharedFiles::SharedFiles(const Ranks& ranks, const Scenario& scenario, const std::string& config,
                         std::int64_t first)
    : ranks_(ranks), scenario_(scenario) {
  ranks.together([&] {
    if (!ranks.isFirst()) return;
    const TouchedFiles touched = touchedFiles(scenario, config);
    checkTouchedFiles(touched);
    if (!scenario.energy.empty()) energy_.emplace(scenario.energy);
    if (!scenario.save_state.empty()) state_.emplace(scenario.save_state);
    if (!touched.frame_folder.empty())
      frames_.emplace(touched.frame_folder, scenario.frames, first);
  });
}

std::int64_t SharedFiles::writeTexts(const std::string& path, const std::string& text) const {
  std::int64_t length = 0;
  const std::int64_t offset = ranks_.sumBefore(static_cast<std::int64_t>(text.size()), length);
  ranks_.together([&] { writeAt(path, offset, text); });
  return length;
}

void SharedFiles::write(std::int64_t frame, const ChainPart& part, const EnergyEntry& entry) {
  const Stopwatch stopwatch(seconds_);
  if (!scenario_.save_state.empty()) {
    last_ = part.state();
    last_head_ = {part.particles(), frame, entry.time};
  }
  std::string path;
  ranks_.together([&] {
    if (energy_) energy_->write(frame, entry, std::numeric_limits<double>::quiet_NaN());
    if (!frames_) return;
    frames_->beginFrame(frame);
    path = frames_->unfinishedPath();
  });
  path = ranks_.shareFromFirst(path);
  if (path.empty()) return;
  formatFrame(part, text_);
  const std::int64_t length = writeTexts(path, text_);
  ranks_.together([&] {
    if (frames_) frames_->endFrame(length);
  });
}

void SharedFiles::finish(const ChainPart& part) {
  const Stopwatch stopwatch(seconds_);
  if (!scenario_.save_state.empty()) {
    text_ = ranks_.isFirst() ? last_head_.text() : "";
    text_ += stateLines(part.chain().masses(), last_, part.firstRow(), last_.size());
    writeTexts(ranks_.shareFromFirst(fullPath(followLinks(scenario_.save_state)) + kUnfinished),
               text_);
  }
  ranks_.together([&] {
    if (energy_) energy_->finish();
    if (state_) state_->finish();
    if (frames_) frames_->close();
  });
}

std::string SharedFiles::destination() const {
  if (!frames_) return "";
  const std::int64_t earlier = frames_->earlierFrames();
  return fmt::format(
      " to {}{}", frames_->path(),
      earlier > 0 ? fmt::format(" ({} removed)", counted(earlier, "earlier frame")) : "");
}

}  // namespace spring_pendulum
