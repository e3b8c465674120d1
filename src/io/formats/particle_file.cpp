#include "io/files/text_file.hpp"
#include "io/formats/particle_parser.hpp"
#include <spring_pendulum/io/particle_file.hpp>

namespace spring_pendulum {

Scene parseParticles(std::string_view text, std::string_view name) {
  ParticleParser parser(name);
  parser.parse(text);
  Scene particles = parser.particles();
  particles.state.velocities().row(0).setZero();  // the first particle is fixed
  return particles;
}

Scene readParticleFile(const std::string& path) {
  return parseParticles(readTextFile(path), path);
}

}  // namespace spring_pendulum
