// An oracle: the motion of any chain in extended precision, and how sensitive it is.
//
// Shares no code with the library. Two methods: Gragg-Bulirsch-Stoer extrapolation of order 20, and
// for light particles, for which this is too slow, Radau IIA of order 9 with the tension of every
// spring as an unknown, full Newton iterations and dense algebra. Work is bounded by counting, not
// by a clock, so the same scenes are solved on every machine.
//
// Reference: E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd
// ed., Springer 1993, section II.9; E. Hairer, G. Wanner, Solving ODEs II, 1996, section IV.8.
#pragma once

#include <optional>
#include <vector>

#include "support/scene.hpp"

namespace spring_pendulum::test {

enum class OracleMethod { kExtrapolation, kRadau };

struct ExactMotion {
  std::vector<State> states;  ///< at the times interval, 2 interval, ...
  /// Largest factor by which small random perturbations of the start positions grew.
  double growth = 0.0;
};

/// Returns the method that suits the scene.
OracleMethod oracleMethodFor(const Scene& scene);

/// Returns the states at `interval`, ..., `outputs` x `interval` s. The error of each position is
/// about 1e-12 m times the growth.
/// \param budget approximate limit of the processor time, s
/// \param perturbation largest random change of the start coordinates, except those of P_1, m
/// \returns nothing if the budget does not suffice
std::optional<std::vector<State>> solveExactly(const Scene& scene, double interval, int outputs,
                                               double budget, OracleMethod method,
                                               double perturbation = 0.0);

/// Solves the scene and a slightly changed one, with half the budget each.
std::optional<ExactMotion> exactMotion(const Scene& scene, double interval, int outputs,
                                       double budget);

}  // namespace spring_pendulum::test
