// The heat of one step of an error-controlled method, from its dense output.
#pragma once

#include "integration/error_control/adaptive_stepper.hpp"
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>

namespace spring_pendulum {

/// Dissipated power integrated from the beginning of the last step to `fraction` of it, J, by
/// Gauss-Legendre quadrature with six nodes: exact up to degree 11, so the dense output and not the
/// quadrature decides how accurate it is.
/// \param length  of that step, s
/// \param scratch of the size of the chain, overwritten
double heatOfStep(const AdaptiveStepper& stepper, const Chain& chain, double length,
                  double fraction, State& scratch);

}  // namespace spring_pendulum
