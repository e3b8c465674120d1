// Arbitrary bytes give a valid chain or an error of one line with its place.
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <fmt/format.h>

#include <cstring>
#include <string>

#include "fuzz_target.hpp"

namespace {

using namespace spring_pendulum;

bool sameBits(const Scene& a, const Scene& b) {
  const auto bytes = [](Eigen::Index numbers) {
    return static_cast<std::size_t>(numbers) * sizeof(double);
  };
  return a.masses.size() == b.masses.size() &&
         std::memcmp(a.masses.data(), b.masses.data(), bytes(a.masses.size())) == 0 &&
         std::memcmp(a.state.values().data(), b.state.values().data(),
                     bytes(a.state.values().size())) == 0;
}

void checkParticles(const Scene& particles) {
  const Eigen::Index size = particles.masses.size();
  require(size >= 1 && particles.state.size() == size, "at least one particle");
  require(particles.state.values().allFinite(), "finite positions");
  require(Chain(particles.masses, SpringLaw{}, 9.81).size() == size, "masses that a chain accepts");
  std::string text;
  for (Eigen::Index i = 0; i < size; ++i) {
    text += fmt::format("{} {} {}\n", particles.state.x()[i], particles.state.y()[i],
                        particles.masses[i]);
  }
  require(sameBits(parseParticles(text, ""), particles),
          "the same bits when written and read, so no -0.0");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  try {
    checkParticles(parseParticles(text, "particle.txt"));
  } catch (const InputError& error) {
    const std::string message = error.what();
    require(message.rfind("particle.txt:", 0) == 0, "a message that tells where");
    require(message.find("must") != std::string::npos || message.find("; ") != std::string::npos,
            "a message that tells what is right");
    require(message.find_first_of("\r\n\t") == std::string::npos, "a message of one line");
  }
  return 0;
}
