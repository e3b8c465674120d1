// The unit of `Integrator::work`: nominal computing times of evaluations of F. All limits on the cost
// of reference runs and trials count in this unit.
#pragma once

#include <cstddef>

namespace spring_pendulum {

/// Time of an evaluation in Taylor-8 for a chain, s. Measured: 2 to 5 ns per particle, with the
/// overhead of 8 more particles.
inline double nominalTaylorTime(std::ptrdiff_t particles) {
  return 3e-9 * (static_cast<double>(particles) + 8.0);
}

/// Time of an evaluation in a method with fixed steps, s. Measured, relative to Taylor-8: 0.36 with 2
/// particles, 0.4 with 11, 0.7 with 50, 1.1 with 100, 2.1 with 300.
inline double nominalFixedStepTime(std::ptrdiff_t particles) {
  return (0.35 + 0.007 * static_cast<double>(particles)) * nominalTaylorTime(particles);
}

}  // namespace spring_pendulum
