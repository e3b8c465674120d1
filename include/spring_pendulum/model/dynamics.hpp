// The right-hand side F of z' = F(z), spring forces and lengths, and the shape of a chain at rest.
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

/// Length in m to which position errors are related at the start: the sum of the rest lengths, but at
/// least a tenth of the length of the chain (for springs with rest length 0).
double chainLength(const Chain& chain, const State& start);

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

/// Returns the stable equilibrium of a chain under gravity and the applied forces of its drive, with all
/// springs stretched and all velocities 0. Held particles stay where they are in `state`.
///
/// Between two held particles, the force of one spring determines those of all others, and the true one
/// minimises a strictly convex function of two variables, the complementary energy. Newton's method
/// finds the minimum. Beyond the last held particle, each spring carries what hangs from it.
///
/// Reference: S. P. Timoshenko, D. H. Young, Theory of Structures, 2nd ed., McGraw-Hill 1965, section
/// 6.3 (complementary energy).
/// \throws InputError if the size of the state is not that of the chain, or if there is no such
///   equilibrium: without stiffness, or where a spring would be compressed or have no length
State equilibrium(const Chain& chain, const State& state);

}  // namespace spring_pendulum
#pragma GCC visibility pop
