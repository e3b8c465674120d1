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
/// \param keep_negative_zeros else, -0.0 becomes 0.0
/// \throws InputError with file and line for the first invalid line
ParticleRows parseRows(std::string_view text, std::string_view name,
                       bool keep_negative_zeros = false);

}  // namespace spring_pendulum
