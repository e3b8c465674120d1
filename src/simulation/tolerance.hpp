// Validation of the tolerance.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>

namespace spring_pendulum {

/// Checks that the tolerance of an error-controlled method is above the rounding errors of the
/// positions. With a smaller tolerance the step size would shrink until the run makes no progress.
/// \throws InputError naming the smallest possible tolerance
void checkTolerance(double tolerance, const Chain& chain, const State& start);

}  // namespace spring_pendulum
