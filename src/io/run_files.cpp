#include "io/run_files.hpp"

#include <filesystem>

namespace spring_pendulum {

RunFiles::RunFiles(const Scenario& scenario) {
  if (!scenario.energy.empty()) {
    energy_.emplace(scenario.energy);
    energy_path_ = std::filesystem::absolute(scenario.energy).lexically_normal().string();
  }
  if (!scenario.no_frames && !scenario.output.empty()) {
    frames_.emplace(scenario.output, scenario.frames);
  }
}

void RunFiles::write(std::int64_t frame, const State& state, const EnergyEntry& entry,
                     double position_error) {
  if (finished_ || frame < next_frame_) return;
  if (frames_) frames_->write(frame, state);
  if (energy_) energy_->write(frame, entry, position_error);
  next_frame_ = frame + 1;
}

void RunFiles::finish() {
  if (finished_) return;
  finished_ = true;
  if (frames_) frames_->finish();
  if (energy_) energy_->finish();
}

std::string RunFiles::description() const {
  std::string text = frames_ ? "frames go to " + frames_->folder() : "no frame files";
  if (energy_) text += ", the energy balance to " + energy_path_;
  return text;
}

}  // namespace spring_pendulum
