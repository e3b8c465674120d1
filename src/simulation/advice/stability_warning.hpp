// A warning before the first step of a run whose time step is too large.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <string>

namespace spring_pendulum {

/// Returns a line of text if the time step is clearly above the stability limit of the method,
/// whatever the positions of the particles; else empty. O(N), negligible compared with a run.
std::string stabilityWarning(const Chain& chain, const Scenario& scenario);

/// The same, but also tries the first steps of the run, for at most about 0.02 s.
std::string stabilityWarning(const Chain& chain, const State& start, const Scenario& scenario);

}  // namespace spring_pendulum
