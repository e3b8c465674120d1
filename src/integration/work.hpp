// The unit of `Integrator::work`: nominal computing times of evaluations of F. All limits on the cost
// of reference runs and trials count in this unit, and `Auto` compares its methods by it. They are
// constants, so what depends on them is the same on every machine.
#pragma once

#include <cstddef>

namespace spring_pendulum {

/// Time in s of one evaluation for the whole chain, with its share of all other work of a step.
/// Measured with AVX2 for 2 to 10,000 particles; mostly within a factor of 2, but up to 8 for short chains.
struct NominalTime {
  double per_particle;
  double overhead = 8.0;  ///< in particles

  constexpr double of(std::ptrdiff_t particles) const {
    return per_particle * (static_cast<double>(particles) + overhead);
  }
};

constexpr NominalTime kFixedStepTime{2e-9, 3.0};
constexpr NominalTime kTaylorTime{3e-9};
constexpr NominalTime kStabilizedTaylor8Time{1.15 * 3e-9};
/// Steps of order 4 have fewer terms to share the work that is done once per step.
constexpr NominalTime kStabilizedTaylor4Time{1.4 * 3e-9};
/// The linear algebra of the implicit methods uses no vector instructions.
constexpr NominalTime kRadauTime{41e-9, 0.0};
constexpr NominalTime kBackwardEulerTime{30e-9, 0.0};

}  // namespace spring_pendulum
