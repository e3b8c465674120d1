// State files: particle files with velocities whose first line names a frame and its time, so that a
// run can go on from there.
//
//     # state of 11 particles at frame 250, t = 25 s
//     # x [m]  y [m]  mass [kg]  vx [m/s]  vy [m/s]
#pragma once

#include "io/files/output_file.hpp"
#include <spring_pendulum/base/aligned_numbers.hpp>
#include <spring_pendulum/model/scene.hpp>
#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <cstdint>
#include <string>
#include <string_view>

namespace spring_pendulum {

/// Reads the state file `Scenario::particles`. Numbers keep the sign of -0.0: a fixed-step run from
/// this state has the bits of the run that saved it.
/// \throws FileError, InputError
Scene readStateFile(const Scenario& scenario);

/// Writes a state file. Replaces no file of another kind.
/// \throws FileError, InputError as OutputFile
void writeStateFile(const std::string& path, const Chain& chain, const State& state,
                    std::int64_t frame, double time);

/// Writes the state at the last frame of a run when the run is over. The file is complete or absent,
/// like every OutputFile.
class StateFile {
 public:
  /// Same arguments and errors as OutputFile.
  explicit StateFile(const std::string& path) : file_(path) {}

  /// Keeps the state of a run that is at a frame. After a stop inside a frame, the last frame counts.
  void keep(const Run& run);
  /// Writes the state that was kept last.
  /// \throws FileError naming the file
  void finish();

  /// Absolute path.
  const std::string& path() const { return file_.path(); }

 private:
  OutputFile file_;
  Scene last_;
  double time_ = 0.0;  ///< s
};

}  // namespace spring_pendulum
