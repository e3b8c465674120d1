// The right-hand side F of the equations of motion z' = F(z), spring forces and lengths.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/spring_law.hpp>
#include <spring_pendulum/model/state.hpp>

#include <cstddef>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Returns the length in m of spring i, between particles i and i+1, counted from 0.
inline double springLength(const State& state, std::ptrdiff_t i) {
  return lengthOf({state.x()[i + 1] - state.x()[i], state.y()[i + 1] - state.y()[i]});
}

/// Returns the sum of the lengths of the springs begin <= i < end, m.
inline double springLengths(const State& state, std::ptrdiff_t begin, std::ptrdiff_t end) {
  double sum = 0.0;
  for (std::ptrdiff_t i = begin; i < end; ++i) sum += springLength(state, i);
  return sum;
}

/// Returns the force in N of spring i (between particles i and i+1, counted from 0) on particle i.
/// \throws InputError if the chain has no such spring or the size of the state is not that of the
/// chain
PlaneVector<double> springForceOn(const Chain& chain, const State& state, std::ptrdiff_t i);

/// Computes the slope z' = F(z): the velocities in the columns x and y, m/s, and the accelerations
/// (sum of spring forces - k_air v)/m + (0, -g) in the columns vx and vy, m/s². All 0 for the first
/// particle, which is fixed. Held particles and applied forces count as
/// `Chain::springlessAcceleration` says.
/// \param[out] slope must not be `state`; resized to the chain if needed
/// \throws InputError if the size of the state is not that of the chain
void computeSlope(const Chain& chain, const State& state, State& slope);

}  // namespace spring_pendulum
#pragma GCC visibility pop
