// Particle files: the initial positions, masses and, optionally, initial velocities of the particles.
//
// A line `x y m` (m, m, kg) or `x y m vx vy` (velocities in m/s) for each particle, in the order of
// the chain. All lines have velocities or none. The first particle is fixed; its mass and its
// velocity are not used. Blank lines, `#` comments, tabs, CRLF, a byte order mark
// and a missing newline at the end are accepted. Numbers are decimal, with a point in every locale.
#pragma once

#include <spring_pendulum/model/scene.hpp>

#include <string>
#include <string_view>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Returns the particles, at rest if the file has no velocities.
/// \throws FileError if the file can't be read
/// \throws InputError with file and line for the first invalid line
Scene readParticleFile(const std::string& path);

/// Reads particles from text.
/// \param name name of the text in error messages
Scene parseParticles(std::string_view text, std::string_view name);

}  // namespace spring_pendulum
#pragma GCC visibility pop
