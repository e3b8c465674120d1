// The shape of a chain at rest.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>

#pragma GCC visibility push(default)
namespace spring_pendulum {

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
