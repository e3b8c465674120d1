// Particles at the start of a run.
#pragma once

#include <spring_pendulum/base/aligned_numbers.hpp>
#include <spring_pendulum/model/state.hpp>

#include <cstdint>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// N >= 1 particles.
struct Particles {
  AlignedNumbers masses;  ///< N masses, kg
  State state;  ///< N positions and velocities; none is -0.0, so that x + 0 has the bits of x
  std::int64_t frame = 0;  ///< of this state; above 0 if a run goes on from a saved state
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
