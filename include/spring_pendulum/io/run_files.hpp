// Where a run starts and what it writes: the files that its scenario names.
#pragma once

#include <spring_pendulum/model/scene.hpp>
#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <memory>
#include <string>
#include <string_view>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Reads the scene of a scenario: from its particle file, or from the saved state from which it resumes.
/// \param argument how to name another file, for the error if the default file does not exist
/// \throws FileError if the file can't be read
/// \throws InputError with file and line for the first invalid line, and as makeScene
Scene readScene(const Scenario& scenario, std::string_view argument = "--particles");

/// Writes frames, energy balance and last state, as far as the scenario asks for them: no frames with
/// `no_frames` or an empty `output`. Writes every frame once, as a run that is reset repeats its frames.
/// A process that is forked afterwards must neither use nor destroy it.
class RunFiles {
 public:
  /// Checks that no name has two uses, opens the files and removes the frames of an earlier run.
  /// \param config configuration file of the run, which must not be overwritten; empty: none
  /// \throws InputError, also for energies of a run without `track_dissipation`, FileError naming the file
  RunFiles(const Run& run, const Scenario& scenario, const std::string& config = "");
  ~RunFiles();

  /// Writes the current frame of a run unless it has been written before or must not be shown. Notes
  /// the state in any case.
  /// \throws FileError naming the file; all later calls of `write` and `finish` throw, too
  void write(const Run& run);

  /// Completes the files, as `write` does at the last frame. No write after this.
  /// \throws FileError naming the file
  void finish();

  /// "frames go to /home/me/frames (500 earlier frames removed), energies go to ..."
  std::string description() const;
  /// For `Run::closingLine`, after `finish`: ", 3 ms writing to /home/me/frames"; empty without frames.
  std::string closingText() const;

 private:
  struct Files;
  std::unique_ptr<Files> files_;
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
