// An oracle: the motion of any chain, and how sensitive it is.
//
// Extrapolation in extended precision, which shares no code with the library; for light particles and
// stiff springs, for which this is too slow, Radau-9 with the tolerance 1e-11 m, whose errors on such
// chains are measured against motions in extended precision (integration_implicit_radau_stepper_test).
// Work is bounded by counting, not by a clock, so the same scenes are solved on every machine.
#pragma once

#include <optional>
#include <vector>

#include "support/scene.hpp"

namespace spring_pendulum::test {

struct ExactMotion {
  std::vector<State> states;  ///< at the times interval, 2 interval, ...
  /// Largest factor by which small random perturbations of the start positions grew.
  double growth = 0.0;
};

/// Returns the states at `interval`, ..., `outputs` x `interval` s, within 1e-11 m or 1e-12 m times the growth.
/// \param budget approximate limit of the processor time, s; if it does not suffice, nothing is returned
std::optional<ExactMotion> exactMotion(const Scene& scene, double interval, int outputs,
                                       double budget);

}  // namespace spring_pendulum::test
