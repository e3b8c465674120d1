// Frequencies of the linearised motion of a chain about its hanging equilibrium.
//
// Along the chain, mode j of the springs obeys q'' + k_d μ_j q' + k_s μ_j q = 0, where μ_j is an
// eigenvalue of B M^-1 B^T (B: differences of neighbours, M: masses), because the damping matrix is
// proportional to the stiffness matrix. In any other shape of the chain the coupling is weaker, so
// the largest μ is an upper bound for all shapes. In the transverse direction the tension T_i of
// spring i of length L_i acts as an undamped stiffness T_i/L_i.
//
// Reference: J. W. S. Rayleigh, The Theory of Sound I, 2nd ed., 1894, §§97-102 and 120.
#pragma once

#include <spring_pendulum/model/chain.hpp>

namespace spring_pendulum {

/// Upper bound of the largest μ in 1/kg, at most 1e-4 (relative) above it; 0 without springs. O(N).
double largestSpringMode(const Chain& chain);

/// Upper bound of the angular frequency of an undamped mode in rad/s, sqrt(k_s μ). O(N).
double fastestVibration(const Chain& chain);

/// Upper bound of the largest damping rate of a mode in 1/s, k_d μ + k_air/m. O(N).
double largestDampingRate(const Chain& chain);

/// Largest diagonal entry of B M^-1 B^T in 1/kg: the value of one spring between its two particles. A
/// lower bound of the largest μ for every shape of the chain; 0 without springs. O(N).
double stiffestSpring(const Chain& chain);

/// Angular frequency in rad/s of the hanging chain swinging as a rigid body, a few percent above
/// the slowest transverse mode. Uses at most the ten springs at the free end: within a run of
/// practical length, the parts of a longer chain swing independently. 0 without gravity or springs.
/// O(N).
double slowSwing(const Chain& chain);

}  // namespace spring_pendulum
