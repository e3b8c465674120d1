// The files of a run: frames and energy balance, as Exercise3 writes them.
#pragma once

#include "io/background_frame_writer.hpp"
#include "io/energy_file.hpp"
#include "ros/pendulum_run.hpp"

#include <optional>

namespace spring_pendulum {

/// Writes every frame once: after a reset the same frames come again, bit for bit.
class RunFiles {
 public:
  /// With `no_frames` or an empty `output` there are no frames, with an empty `energy` no energy balance.
  /// \throws FileError naming the folder or file
  explicit RunFiles(const Scenario& scenario);

  /// Writes the frame if the run stands at one that is new and may be shown, and closes the files
  /// after the last one.
  /// \throws FileError naming the file
  void write(const PendulumRun& run);

  /// Closes the files; nothing is written after this.
  void finish();

  /// "frames go to /home/me/frames, the energy balance to ..."
  std::string description() const;
  std::int64_t framesWritten() const { return frames_ ? next_frame_ : 0; }
  /// Wall-clock time spent writing frames, s. Only after `finish`.
  double seconds() const { return frames_ ? frames_->secondsWriting() : 0.0; }

 private:
  std::optional<BackgroundFrameWriter> frames_;
  std::optional<EnergyFile> energy_;
  std::string energy_path_;
  std::int64_t next_frame_ = 0;
  bool finished_ = false;
};

}  // namespace spring_pendulum
