#include "base/checks.hpp"
#include <spring_pendulum/model/state.hpp>

#include <limits>
#include <new>

namespace spring_pendulum {
namespace {

std::ptrdiff_t numbersOf(std::ptrdiff_t particles) {
  requireAtLeastZero("number of particles", particles);
  if (particles > std::numeric_limits<std::ptrdiff_t>::max() / 4) throw std::bad_alloc();
  return 4 * particles;
}

}  // namespace

State::State(std::ptrdiff_t particles) : numbers_(numbersOf(particles)) {}

}  // namespace spring_pendulum
