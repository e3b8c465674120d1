#include "io/formats/run_files.hpp"

#include "base/numbers.hpp"

#include <fmt/format.h>

#include <string>

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

RunFiles::RunFiles(const Run& run, const std::string& config) {
  const Scenario& scenario = run.scenario();
  checkTouchedFiles(touchedFiles(scenario, config));
  if (!scenario.energy.empty()) energy_.emplace(scenario.energy);
  if (!scenario.save_state.empty()) state_.emplace(scenario.save_state);
  if (writesFrames(scenario)) frames_.emplace(scenario.output, scenario.frames, run.firstFrame());
}

void RunFiles::write(const Run& run) {
  const std::int64_t frame = run.frame();
  if (finished_ || frame < next_frame_ || !run.isAtFrame() || !run.isShown()) return;
  if (frames_) frames_->write(frame, run.state());
  if (energy_) energy_->write(frame, run.energyEntry(), run.positionError().now);
  if (state_) state_->keep(run);
  next_frame_ = frame + 1;
}

void RunFiles::finish() {
  if (finished_) return;
  finished_ = true;
  if (energy_) energy_->finish();
  if (state_) state_->finish();
  if (frames_) frames_->finish();
}

std::string RunFiles::description() const {
  std::string text = "no frame files";
  if (frames_) text = "frames go to " + frameFolder();
  if (energy_) text += ", energies go to " + energy_->path();
  if (state_) text += ", the last state goes to " + state_->path();
  return text;
}

std::string RunFiles::destination() const {
  return frames_ ? " to " + frameFolder() : "";
}

std::string RunFiles::frameFolder() const {
  const std::int64_t earlier = frames_->earlierFrames();
  if (earlier == 0) return frames_->folder();
  return fmt::format("{} ({} removed)", frames_->folder(), counted(earlier, "earlier frame"));
}

}  // namespace spring_pendulum
