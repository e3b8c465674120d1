// What rounding allows: how small a position error any method can reach.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/export.hpp>
#include <spring_pendulum/model/state.hpp>

namespace SPRING_PENDULUM_API spring_pendulum {

/// Estimates the smallest position error in m that a method can reach within seconds of motion from
/// `start`: a hundred rounding errors of the largest coordinate, of the way covered in a second, or
/// of the chain's own length, whichever is the largest. About 2e-13 m for a chain of 10 m; an
/// anchor at 1e12 m can't be known to better than 0.02 m.
/// \param start as many particles as the chain has
double smallestTolerance(const Chain& chain, const State& start);

}  // namespace spring_pendulum
