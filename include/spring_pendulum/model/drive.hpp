// What acts on a chain besides its springs and gravity: particles whose motion is prescribed, and
// constant forces.
#pragma once

#include <spring_pendulum/model/spring_law.hpp>

#include <cstddef>
#include <vector>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// A particle that moves with constant acceleration, whatever its springs do. It starts with the
/// position and velocity that it has in the state.
struct HeldParticle {
  std::ptrdiff_t particle = 0;         ///< counted from 0
  PlaneVector<double> acceleration{};  ///< m/s²
};

/// A constant force on a particle.
struct AppliedForce {
  std::ptrdiff_t particle = 0;  ///< counted from 0
  PlaneVector<double> force{};  ///< N
};

/// External influences on a chain, constant in time. A motion that is driven in another way consists
/// of several intervals of constant drive. P_1 is always held; without an entry its acceleration is 0.
struct Drive {
  std::vector<HeldParticle> held;
  std::vector<AppliedForce> forces;  ///< several forces on one particle add up

  bool empty() const { return held.empty() && forces.empty(); }
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
