#include "io/formats/run_files.hpp"

#include "base/numbers.hpp"
#include "io/files/paths.hpp"
#include "io/formats/energy_file.hpp"
#include "io/formats/frame_writer.hpp"
#include "io/formats/state_file.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/particle_file.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <system_error>

namespace spring_pendulum {
namespace {

bool writesFrames(const Scenario& scenario) {
  return !scenario.no_frames && !scenario.output.empty();
}

}  // namespace

TouchedFiles touchedFiles(const Scenario& scenario, const std::string& config) {
  return {{scenario.particles, config},
          {scenario.energy, scenario.save_state},
          writesFrames(scenario) ? scenario.output : ""};
}

Scene readScene(const Scenario& scenario, std::string_view argument) {
  namespace fs = std::filesystem;
  std::error_code error;  // other errors are left to the reader
  const bool is_missing = fs::status(scenario.particles, error).type() == fs::file_type::not_found;
  if (is_missing && scenario.particles == Scenario{}.particles) {
    throw FileError(fmt::format("{}: no such file; give a particle file with {}",
                                fullPath(scenario.particles), argument));
  }
  return makeScene(
      scenario, scenario.resume ? readStateFile(scenario) : readParticleFile(scenario.particles));
}

struct RunFiles::Files {
  std::optional<EnergyFile> energy;
  std::optional<StateFile> state;
  std::optional<FrameWriter> frames;
  std::int64_t next_frame = 0;
  std::map<std::int64_t, std::int64_t> left_out;  ///< first frame and end of what a jump left out
  bool finished = false;

  /// Whether a frame is not written yet; counts it as written.
  bool takes(std::int64_t frame) {
    if (frame >= next_frame) {
      if (frame > next_frame) left_out[next_frame] = frame;
      next_frame = frame + 1;
      return true;
    }
    const auto after = left_out.upper_bound(frame);
    if (after == left_out.begin()) return false;
    const auto [first, end] = *std::prev(after);
    if (frame >= end) return false;
    left_out.erase(first);
    if (first < frame) left_out[first] = frame;
    if (frame + 1 < end) left_out[frame + 1] = end;
    return true;
  }

  /// "/home/me/frames (500 earlier frames removed)"
  std::string frameFolder() const {
    const std::int64_t earlier = frames->earlierFrames();
    if (earlier == 0) return frames->folder();
    return fmt::format("{} ({} removed)", frames->folder(), counted(earlier, "earlier frame"));
  }
};

RunFiles::RunFiles(const Run& run, const Scenario& scenario, const std::string& config)
    : files_(new Files) {
  files_->next_frame = run.firstFrame();
  checkTouchedFiles(touchedFiles(scenario, config));
  if (!scenario.energy.empty()) files_->energy.emplace(scenario.energy, run.firstFrame());
  if (!scenario.save_state.empty()) files_->state.emplace(scenario.save_state);
  if (writesFrames(scenario)) {
    files_->frames.emplace(scenario.output, run.firstFrame());
  }
}

RunFiles::~RunFiles() = default;
RunFiles::RunFiles(RunFiles&&) noexcept = default;

void RunFiles::write(const Run& run) {
  Files& to = *files_;
  const std::int64_t frame = run.frame();
  if (to.finished || !run.isAtFrame() || !run.isShown() || !to.takes(frame)) return;
  if (to.frames) to.frames->write(frame, run.state());
  if (to.energy) to.energy->write(frame, run.energyEntry(), run.positionError().now);
  if (to.state) to.state->keep(run);
}

void RunFiles::finish() {
  if (files_->finished) return;
  files_->finished = true;
  if (files_->energy) files_->energy->finish();
  if (files_->state) files_->state->finish();
  if (files_->frames) files_->frames->finish();
}

std::string RunFiles::description() const {
  std::string text = files_->frames ? "frames go to " + files_->frameFolder() : "no frame files";
  if (files_->energy) text += ", energies go to " + files_->energy->path();
  if (files_->state) text += ", the last state goes to " + files_->state->path();
  return text;
}

std::string RunFiles::closingText() const {
  if (!files_->frames) return "";
  return fmt::format(", {} writing to {}", durationText(files_->frames->seconds()),
                     files_->frameFolder());
}

}  // namespace spring_pendulum
