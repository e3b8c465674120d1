// What position error can be aimed at.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

namespace spring_pendulum {

/// Checks that the tolerance of an error-controlled method is above the rounding of the positions;
/// below, a run would take ever shorter steps and not end.
/// \throws InputError naming the smallest possible tolerance
void checkTolerance(const Scenario& scenario, const Chain& chain, const State& start);

}  // namespace spring_pendulum
