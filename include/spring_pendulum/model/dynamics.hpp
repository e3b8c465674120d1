// The right-hand side F of the equations of motion z' = F(z), and the forces in it.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/export.hpp>
#include <spring_pendulum/model/spring_law.hpp>
#include <spring_pendulum/model/state.hpp>

#include <cstddef>

namespace SPRING_PENDULUM_API spring_pendulum {

/// Force in N of spring i (between particles i and i+1, counted from 0) on particle i.
/// \throws InputError if the chain has no such spring or the state is not of the chain's size
PlaneVector<double> springForceOn(const Chain& chain, const State& state, std::ptrdiff_t i);

/// Computes the slope z' = F(z): the velocities in the columns x and y, m/s, and the accelerations
/// (sum of spring forces)/m + (0, -g) in the columns vx and vy, m/s². All 0 for the first particle,
/// which is fixed.
/// \param[out] slope not `state` itself; allocates only if its size differs from the chain's
/// \throws InputError if the state is not of the chain's size
void computeSlope(const Chain& chain, const State& state, State& slope);

}  // namespace spring_pendulum
