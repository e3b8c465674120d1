// A warning before the first step of a run whose time step is too large.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <string>

namespace spring_pendulum {

/// Returns a line of text if the time step is clearly above the stability limit of the method,
/// whatever the positions of the particles; else empty. O(N), negligible compared with a run.
/// \param start if not null, the first steps of the run are tried as well, for at most about 0.02 s
std::string stabilityWarning(const Chain& chain, const Scenario& scenario,
                             const State* start = nullptr);

}  // namespace spring_pendulum
