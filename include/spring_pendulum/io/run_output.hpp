// Where a run starts and what it writes: the files that its scenario names.
#pragma once

#include <spring_pendulum/model/particles.hpp>
#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <memory>
#include <string>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Reads the particle file of a scenario, or the saved state from which it resumes.
/// \throws FileError if the file can't be read
/// \throws InputError with file and line for the first invalid line
Particles readStart(const Scenario& scenario);

/// Writes frames, energy balance and last state, as far as the scenario asks for them.
class RunOutput {
 public:
  /// Checks that no name has two uses, opens the files and removes the frames of an earlier run. An empty
  /// `Scenario::output` means no frames.
  /// \throws InputError, FileError naming the file
  explicit RunOutput(const Run& run);
  ~RunOutput();
  RunOutput(RunOutput&& other) noexcept;

  /// Writes the current frame of a run.
  /// \throws FileError naming the file
  void write(const Run& run);

  /// Completes the files. No write after this.
  /// \throws FileError naming the file
  void finish();

  /// For `Run::closingLine`, after `finish`: ", 3.07 ms writing to /home/me/frames"; empty without frames.
  std::string closingText() const;

 private:
  struct Files;
  std::unique_ptr<Files> files_;
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
