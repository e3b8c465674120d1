// What is simulated: a chain and where it starts.
#pragma once

#include <spring_pendulum/base/aligned_numbers.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>

#include <cstdint>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// N >= 1 particles and what acts on them.
struct Scene {
  AlignedNumbers masses;  ///< N masses, kg
  State state;  ///< N positions and velocities; none is -0.0, so that x + 0 has the bits of x
  std::int64_t frame = 0;  ///< of this state; above 0 if a run goes on from a saved state
  Constants constants = {};

  /// \throws InputError as Chain
  Chain chain() const { return {masses, constants}; }
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
