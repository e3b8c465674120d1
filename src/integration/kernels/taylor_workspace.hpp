// The numbers that the kernels of the Taylor series method work on. The method itself is explained
// in taylor_stepper.hpp.
#pragma once

#include <spring_pendulum/model/spring_law.hpp>

#include <cstddef>

namespace spring_pendulum {

inline constexpr std::ptrdiff_t kLargestTaylorOrder = 14;

/// Taylor coefficients of the motion of a chain about one moment. Spring i joins particles i and
/// i+1; where there is none (behind the chain's end) its coefficients are without effect.
struct TaylorWorkspace {
  SpringLaw spring;
  double gravity = 0.0;                         ///< m/s²
  const double* inverse_masses = nullptr;       ///< `pitch` numbers, 1/kg; 0: fixed or none
  const double* next_inverse_masses = nullptr;  ///< the same of the next particle in the chain
  std::ptrdiff_t size = 0;                      ///< N >= 1 particles
  std::ptrdiff_t pitch = 0;                     ///< a multiple of 8, at least N
  std::ptrdiff_t order = 0;  ///< K in 2..14: how many coefficients the forces have

  /// Eight springs at a time: K + 3 rows of 4 times 8 numbers. The first row holds 1/L_0 times the
  /// separation (x, y), and 1/L_0; the second sums for the next order; row n + 2 coefficient n of
  /// the separation (x, y), the length L and the quotient u = T/L.
  double* springs = nullptr;
  /// K times 2 times `pitch` numbers: coefficient n of the accelerations (x, y).
  double* accelerations = nullptr;

  [[gnu::always_inline]] static std::ptrdiff_t springRows(std::ptrdiff_t order) {
    return order <= 12 ? 15 : 31;
  }
  static std::ptrdiff_t springNumbers(std::ptrdiff_t pitch, std::ptrdiff_t order) {
    return pitch * 4 * springRows(order);
  }
  static std::ptrdiff_t accelerationNumbers(std::ptrdiff_t pitch, std::ptrdiff_t order) {
    return pitch * 2 * order;
  }
};

/// What is summed: of the accelerations' coefficients n < `count` so many times each makes a change
/// of the positions, and of the velocities; of the velocities at the start, a change of positions.
struct TaylorWeights {
  std::ptrdiff_t count = 0;
  double start_velocity = 0.0;                ///< s
  double position[kLargestTaylorOrder] = {};  ///< s^(n+2)
  double velocity[kLargestTaylorOrder] = {};  ///< s^(n+1)
};

}  // namespace spring_pendulum
