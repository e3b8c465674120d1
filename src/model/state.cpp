#include "base/checks.hpp"
#include <spring_pendulum/model/state.hpp>

#include <limits>
#include <new>

namespace spring_pendulum {

State::State(std::ptrdiff_t particles) {
  requireAtLeastZero("number of particles", particles);
  if (particles > std::numeric_limits<std::ptrdiff_t>::max() / 4) throw std::bad_alloc();
  numbers_ = AlignedNumbers(4 * particles);
}

}  // namespace spring_pendulum
