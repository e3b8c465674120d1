// One case of a study by itself.
#pragma once

#include <cstdint>
#include <string>

#include "sweep/study/study.hpp"

namespace spring_pendulum::sweep {

/// Returns the particle file that `printCase` writes for a case whose particles are in no file.
std::string particlesPath(const std::string& folder, std::int64_t index);

/// Prints a case as a command line of Exercise3.
/// \param folder for the frames, and for particles that are in no file; empty: none
/// \throws InputError also if there is no such case
void printCase(const Study& study, std::int64_t index, const std::string& folder);

}  // namespace spring_pendulum::sweep
