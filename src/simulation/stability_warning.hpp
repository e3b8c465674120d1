// A warning before the first step of a run whose time step is too large.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <string>

namespace spring_pendulum {

/// One line about a time step that is clearly above the stability limit of the method, whatever
/// shape the chain takes; else empty. Looks at the masses once, so it costs nothing beside a run.
std::string stabilityWarning(const Chain& chain, const Scenario& scenario);

/// The same, or else the result of trying the start of the run for at most some 0.02 s.
std::string stabilityWarning(const Chain& chain, const State& start, const Scenario& scenario);

}  // namespace spring_pendulum
