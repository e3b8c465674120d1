// How fast a chain can move: the frequencies of its linearised motion about the hanging rest.
//
// Along the chain, mode j of the springs obeys q'' + k_d μ_j q' + k_s μ_j q = 0, where μ_j is an
// eigenvalue of B M^-1 B^T (B: differences of neighbours, M: masses), because the damping matrix is
// proportional to the stiffness matrix. In any other shape of the chain the springs couple less, so
// the largest μ bounds it in all shapes. Sideways the tension T_i of spring i of length L_i acts as
// a stiffness T_i/L_i, and nothing damps.
//
// Reference: J. W. S. Rayleigh, The Theory of Sound I, 2nd ed., 1894, §§97-102 and 120.
#pragma once

#include <spring_pendulum/model/chain.hpp>

namespace spring_pendulum {

/// Largest μ in 1/kg, from above and within 1e-4 of it; 0 for a chain without springs. O(N).
double largestSpringMode(const Chain& chain);

/// Largest diagonal entry of B M^-1 B^T in 1/kg: what one spring between its two particles gives.
/// A lower bound of the largest μ in every shape of the chain; 0 without springs. One pass.
double stiffestSpring(const Chain& chain);

/// Angular frequency in rad/s of the hanging chain swinging as if rigid, a few percent above that
/// of the slowest sideways mode. Of a long chain only the ten springs at the free end, as in a run
/// of any practical length it swings in parts. 0 without gravity or without springs. O(N).
double slowSwing(const Chain& chain);

}  // namespace spring_pendulum
