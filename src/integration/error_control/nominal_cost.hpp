// Nominal computing times of the methods: the unit in which work is counted and methods are compared.
// They are constants, so choices and limits that depend on them are the same on every machine.
#pragma once

#include <Eigen/Core>

namespace spring_pendulum {

/// Time in s of one force evaluation of the whole chain, with its share of all other work of a
/// step. Measured with AVX2 at 3 GHz for 2 to 10,000 particles; within a factor of 2 of every
/// measurement.
struct NominalCost {
  double per_evaluation;
  double per_particle;

  double of(Eigen::Index particles) const {
    return per_evaluation + per_particle * static_cast<double>(particles);
  }
};

constexpr NominalCost kTaylorCost{50e-9, 3.5e-9};
constexpr NominalCost kStabilizedTaylor8Cost{57e-9, 4.0e-9};
/// Steps of order 4 have fewer terms to share the work that is done once per step.
constexpr NominalCost kStabilizedTaylor4Cost{70e-9, 4.9e-9};
/// Linear algebra without vector instructions.
constexpr NominalCost kRadauCost{30e-9, 48e-9};

}  // namespace spring_pendulum
