// Particle files: where the particles of a chain start, and how heavy they are.
//
// A line `x y m` (m, m, kg) for each particle, in the order of the chain; the first one is the
// fixed one and its mass is never used. Blank lines, `#` comments, tabs, CRLF, a byte order mark
// and a missing newline at the end are accepted. Numbers are decimal, with a point in every locale.
#pragma once

#include <spring_pendulum/model/aligned_numbers.hpp>
#include <spring_pendulum/model/export.hpp>
#include <spring_pendulum/model/state.hpp>

#include <string>
#include <string_view>

namespace SPRING_PENDULUM_API spring_pendulum {

/// N >= 1 particles at rest.
struct Particles {
  AlignedNumbers masses;  ///< N masses, kg
  State state;            ///< N positions; no -0.0 among them, so that x + 0 is always x
};

/// \throws FileError if the file can't be read
/// \throws InputError naming file and line for the first line that is wrong
Particles readParticleFile(const std::string& path);

/// The same for text in memory.
/// \param name what messages call the text
Particles parseParticles(std::string_view text, std::string_view name);

}  // namespace spring_pendulum
