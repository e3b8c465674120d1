// Eigenvalues of the motion, linearised about one of its states.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>

#include <complex>
#include <vector>

namespace spring_pendulum {

/// Returns the 4 (N - 1) eigenvalues in 1/s of the Jacobian of F at a state, in no particular order. A
/// step of size h multiplies the part of a small perturbation that belongs to λ by R(hλ), see
/// linear_stability.hpp. Takes O(N³).
/// \throws InputError if the size of the state is not that of the chain, or the state is not finite
std::vector<std::complex<double>> eigenvalues(const Chain& chain, const State& state);

}  // namespace spring_pendulum
