// The output files of a run, for Exercise3 and the node: frames, energy balance and last state.
#pragma once

#include "io/files/touched_files.hpp"
#include "io/formats/background_frame_writer.hpp"
#include "io/formats/energy_file.hpp"
#include "io/formats/state_file.hpp"
#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace spring_pendulum {

/// Returns the files of a run.
/// \param config configuration file; empty: none
TouchedFiles touchedFiles(const Scenario& scenario, const std::string& config);

/// Writes every frame once. A run that is reset repeats its frames bit for bit, so they are not
/// written again.
class RunFiles {
 public:
  /// Writes no frames with `no_frames` or an empty `output`, no energy balance with an empty
  /// `energy`, no state with an empty `save_state`.
  /// \param config configuration file of the run; empty: none
  /// \throws InputError, FileError as checkTouchedFiles, EnergyFile, StateFile and FrameWriter
  explicit RunFiles(const Run& run, const std::string& config = "");

  /// Writes the current frame of a run unless it has been written before or must not be shown.
  /// \throws FileError naming the file
  void write(const Run& run);

  /// Closes the files. No write after this.
  void finish();

  /// "frames go to /home/me/frames (500 earlier frames removed), energies go to ..."
  std::string description() const;
  /// " to /home/me/frames (500 earlier frames removed)", empty without frames
  std::string destination() const;
  /// Wall-clock time spent writing frames, s. Valid after `finish`.
  double secondsWriting() const { return frames_ ? frames_->secondsWriting() : 0.0; }
  /// Wall-clock time that the run waited for the frame writer, s.
  double secondsWaited() const { return frames_ ? frames_->secondsWaited() : 0.0; }

 private:
  /// "/home/me/frames (500 earlier frames removed)"
  std::string frameFolder() const;

  std::optional<EnergyFile> energy_;
  std::optional<StateFile> state_;
  std::optional<BackgroundFrameWriter> frames_;
  std::int64_t next_frame_ = 0;
  bool finished_ = false;
};

}  // namespace spring_pendulum
