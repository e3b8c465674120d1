// Skipping the steps of a chain at rest. This changes results within a tolerance, so it is off by
// default.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>

namespace spring_pendulum {

/// Whether the speed of every particle is at most `tolerance` m/s, and its current acceleration
/// changes the velocity by at most this in `duration` s. The second condition excludes particles at
/// a turning point.
bool isAtRest(const Chain& chain, const State& state, double duration, double tolerance);

}  // namespace spring_pendulum
