#include "base/numbers.hpp"
#include "io/files/posix.hpp"
#include "io/files/touched_files.hpp"
#include "io/formats/frame_writer.hpp"
#include "io/formats/state_file.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/io/run_files.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

namespace spring_pendulum {
namespace {

constexpr const char* kIncomplete = "the output is incomplete: an earlier frame was not written";

/// Begins the energy balance of a run as CSV: one row per frame. Every number is the shortest text that
/// reads back as the same double; the position error is nan where it is not measured.
/// \param first frame of the first row; rows of earlier frames that the file has stay in it
/// \throws InputError for a file of another kind, or one that a spreadsheet has changed
void beginEnergies(OutputFile& file, std::int64_t first) {
  const std::string titles =
      "frame,time [s],kinetic [J],gravity [J],spring [J],total [J],dissipated [J],residual [J],"
      "residual/scale [1],position error [m]";
  file.write(titles + '\n');
  std::istringstream earlier(first > 0 ? file.earlierText() : "");
  bool is_first = true;
  for (std::string row; std::getline(earlier, row); is_first = false) {
    const auto frame = parseInteger(row.substr(0, row.find(',')));
    if (is_first ? row != titles && row != titles + '\r' : !frame)
      throw InputError(file.path() + ": is no energy file of this program; give another name");
    if (frame.value_or(first) < first) file.write(row + '\n');
  }
}

std::string energyRow(std::int64_t frame, const EnergyEntry& entry, double position_error) {
  std::string row = std::to_string(frame);
  for (const double value :
       {entry.time, entry.energy.kinetic, entry.energy.gravity, entry.energy.spring,
        entry.energy.total(), entry.dissipated.value(), entry.residual.value(),
        entry.relative_residual.value(), position_error})
    row += ',' + numberText(value);
  return row + '\n';
}

}  // namespace

Scene readScene(const Scenario& scenario, std::string_view argument) {
  std::error_code error;  // other errors are left to the reader
  const bool is_missing = !std::filesystem::exists(scenario.particles, error) && !error;
  if (is_missing && scenario.particles == Scenario{}.particles)
    throw FileError(fmt::format("{}: no such file; give a particle file with {}",
                                fullPath(scenario.particles), argument));
  return makeScene(
      scenario, scenario.resume ? readStateFile(scenario) : readParticleFile(scenario.particles));
}

struct RunFiles::Files {
  std::optional<OutputFile> energy, state;
  Scene last;  ///< what the state file gets
  double last_time = 0.0;
  std::optional<FrameWriter> frames;
  std::map<std::int64_t, std::int64_t> missing;  ///< first frame and end of what is not written
  bool finished = false;
  bool is_complete = true;  ///< false while it writes, so for ever after an error

  /// Whether a frame is to be written; counts it as written.
  bool takes(std::int64_t frame) {
    if (!frames && !energy) return false;
    const auto after = missing.upper_bound(frame);
    if (after == missing.begin()) return false;
    const auto [first, end] = *std::prev(after);
    if (frame >= end) return false;
    missing.erase(first);
    if (first < frame) missing[first] = frame;  // a run may jump to a later frame and back
    if (frame + 1 < end) missing[frame + 1] = end;
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
  files_->missing[run.firstFrame()] = std::numeric_limits<std::int64_t>::max();
  const TouchedFiles touched = touchedFiles(scenario, config);
  checkTouchedFiles(touched);
  if (!scenario.energy.empty() && !run.energyEntry().dissipated)
    throw InputError("energy: the run must have RunOptions::track_dissipation");
  if (!scenario.energy.empty())
    beginEnergies(files_->energy.emplace(scenario.energy), run.firstFrame());
  if (!scenario.save_state.empty()) files_->state.emplace(scenario.save_state);
  if (!touched.frame_folder.empty()) files_->frames.emplace(touched.frame_folder, run.firstFrame());
}

RunFiles::~RunFiles() = default;

void RunFiles::write(const Run& run) {
  Files& to = *files_;
  const std::int64_t frame = run.frame();
  if (to.finished || run.wasStopped() || !run.isAtFrame() || !run.isShown()) return;
  if (to.state) {  // also of a frame that was written before a reset
    if (to.last.masses.size() == 0) to.last.masses = run.chain().masses();
    to.last.state = run.state();
    to.last.frame = frame;
    to.last_time = run.time();
  }
  if (!std::exchange(to.is_complete, false)) throw FileError(kIncomplete);
  const bool is_new = to.takes(frame);
  if (is_new && to.frames) to.frames->write(frame, run.state());
  if (is_new && to.energy)
    to.energy->write(energyRow(frame, run.energyEntry(), run.positionError().now));
  to.is_complete = true;
  if (run.isOver()) finish();  // of a node, which may go on after a reset
}

void RunFiles::finish() {
  if (files_->finished) return;
  if (!std::exchange(files_->is_complete, false)) throw FileError(kIncomplete);
  if (files_->energy) files_->energy->finish();
  const Scene& last = files_->last;
  if (last.masses.size() > 0)  // else no frame was reached
    writeState(*files_->state, last.masses.view(), last.state, last.frame, files_->last_time);
  if (files_->frames) files_->frames->finish();
  files_->finished = true;
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
