// How fast a chain can move, from its constants alone: bounds that hold in every state.
#pragma once

#include <spring_pendulum/model/chain.hpp>

namespace spring_pendulum {

/// Bound of the rates |λ| of damped modes, 1/s: no mode of v' = M⁻¹ C v decays faster.
///
/// The dashpots' part of a chain has the rates of the matrix over the springs with
/// k_d (1/m_i + 1/m_{i+1}) on its diagonal and, next to it, at most k_d/m of the particle between;
/// its rows sum up to twice the diagonal (Gershgorin). A straight chain comes close to it.
double fastestDampingRate(const Chain& chain);

}  // namespace spring_pendulum
