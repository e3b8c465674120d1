// The smallest position error that rounding allows.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Estimates the smallest position error in m that any method can reach within a few seconds of
/// motion from `start`: a hundred times the rounding error of the largest coordinate, of the
/// distance covered in a second, or of the length of the chain, whichever is largest. Examples:
/// about 2e-13 m for a chain of 10 m; 0.02 m for an anchor at x = 1e12 m.
/// \param start state with the size of the chain
double smallestTolerance(const Chain& chain, const State& start);

/// Checks that the tolerance of an error-controlled method is not below `smallestTolerance`. With a
/// smaller tolerance the step size would shrink until the run makes no progress.
/// \throws InputError naming the smallest possible tolerance
void checkTolerance(double tolerance, const Chain& chain, const State& start);

}  // namespace spring_pendulum
#pragma GCC visibility pop
