// State files: particle files with velocities whose first line names the frame and time to go on from.
//
//     # state of 11 particles at frame 250, t = 25 s
//     # x [m]  y [m]  mass [kg]  vx [m/s]  vy [m/s]
#pragma once

#include "io/files/output_file.hpp"
#include <spring_pendulum/model/scene.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <cstdint>
#include <string>

namespace spring_pendulum {

/// Reads the state file `Scenario::particles`. Numbers keep the sign of -0.0: a fixed-step run from
/// this state has the bits of the run that saved it.
/// \throws FileError, InputError
Scene readStateFile(const Scenario& scenario);

/// Writes and finishes a state file.
/// \param time s
/// \throws FileError naming the file
void writeState(OutputFile& file, const AlignedNumbers::ConstView& masses, const State& state,
                std::int64_t frame, double time);

/// Writes a state file. Replaces no file of another kind.
/// \throws FileError, InputError as OutputFile
void writeStateFile(const std::string& path, const Chain& chain, const State& state,
                    std::int64_t frame, double time);

}  // namespace spring_pendulum
