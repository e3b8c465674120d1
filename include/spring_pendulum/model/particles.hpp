// Particles at the start of a run.
#pragma once

#include <spring_pendulum/base/aligned_numbers.hpp>
#include <spring_pendulum/model/state.hpp>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// N >= 1 particles.
struct Particles {
  AlignedNumbers masses;  ///< N masses, kg
  State state;  ///< N positions and velocities; none is -0.0, so that x + 0 has the bits of x
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
