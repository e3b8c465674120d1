// The rows of particle files and state files.
#pragma once

#include <spring_pendulum/model/scene.hpp>

#include <string_view>

namespace spring_pendulum {

struct ParticleRows {
  Scene particles;  ///< velocities are 0 if the text has none
  bool have_velocities = false;
};

/// Parses a particle file. The mass of the first particle is not checked.
/// \param name of the text in error messages
/// \param is_state neighbours may be in one place, and -0.0 stays -0.0 instead of becoming 0.0
/// \throws InputError with file and line for the first invalid line
ParticleRows parseRows(std::string_view text, std::string_view name, bool is_state = false);

}  // namespace spring_pendulum
