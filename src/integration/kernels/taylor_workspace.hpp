// Input and workspace of the Taylor series kernels. taylor_stepper.hpp derives the method.
#pragma once

#include "integration/kernels/chain_kernels.hpp"

#include <cstddef>

namespace spring_pendulum {

inline constexpr std::ptrdiff_t kLargestTaylorOrder = 14;

/// Taylor coefficients of a chain's motion about one state. Spring i joins particles i and i+1. The
/// columns are padded to `pitch`; the padding holds springs that exert no force.
struct TaylorWorkspace {
  KernelChain chain;  ///< `mass_stride` is 1, which saves multiplications
  /// Inverse masses of the left neighbours of the moving particles, 1/kg; 0 if fixed or padding
  const double* left_inverse_masses = nullptr;
  std::ptrdiff_t order = 0;  ///< K in 2..14, number of force coefficients

  /// Groups of 8 springs, each with `kSpringRows` rows of 4 × 8 doubles. Row n <= 14 holds
  /// coefficient n of the separation (x, y), the length L and the quotient u = T/L. Row 15 holds
  /// the direction d_0/L_0 (x, y) and 1/L_0. Row 16 holds partial sums of the next odd order.
  double* springs = nullptr;
  /// K × 2 columns: coefficient n of the accelerations (x, y).
  double* accelerations = nullptr;

  /// Not 16: groups of 16 rows of 256 bytes would be 4 KiB apart, and loads would wait for stores to
  /// the same row of another group (4K aliasing). The series of 101 particles took 10 % longer.
  static constexpr std::ptrdiff_t kSpringRows = kLargestTaylorOrder + 3;
  static std::ptrdiff_t springNumbers(std::ptrdiff_t pitch) { return pitch * 4 * kSpringRows; }
  static std::ptrdiff_t accelerationNumbers(std::ptrdiff_t pitch, std::ptrdiff_t order) {
    return pitch * 2 * order;
  }
};

/// Weights of the acceleration coefficients 0..count-1 in the position and velocity sums, and of
/// the initial velocities in the position sum. Weights from `count` on are undefined; otherwise they
/// would be set to 0 in every step.
struct TaylorWeights {
  std::ptrdiff_t count = 0;
  double start_velocity = 0.0;           ///< s
  double position[kLargestTaylorOrder];  ///< s^(n+2)
  double velocity[kLargestTaylorOrder];  ///< s^(n+1)
};

}  // namespace spring_pendulum
