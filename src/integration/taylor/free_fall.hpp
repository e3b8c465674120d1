// The end of a level chain that falls freely until the pull of the anchor arrives.
#pragma once

#include "integration/kernels/state_buffer.hpp"
#include <spring_pendulum/model/spring_law.hpp>

namespace spring_pendulum {

/// Whether a spring exerts no force until its neighbours do: it is level, has exactly its rest length,
/// and both ends have the same vertical velocity and no horizontal one.
inline bool fallsFreely(const StateBuffer& state, Eigen::Index spring, double rest_length) {
  const auto z = state.values();
  const double width = z(spring + 1, 0) - z(spring, 0);
  const double square = width * width;
  return z(spring, 1) == z(spring + 1, 1) && z(spring, 2) == 0.0 && z(spring + 1, 2) == 0.0 &&
         z(spring, 3) == z(spring + 1, 3) && square * inverseSquareRoot(square) == rest_length;
}

/// Returns the particle at which the end that falls freely begins, at least 1.
/// \param size number of particles to examine: those beyond fall freely
inline Eigen::Index beginOfFreeFall(const StateBuffer& state, Eigen::Index size,
                                    double rest_length) {
  Eigen::Index first = size - 1;
  while (first > 1 && fallsFreely(state, first - 1, rest_length)) --first;
  return first;
}

}  // namespace spring_pendulum
