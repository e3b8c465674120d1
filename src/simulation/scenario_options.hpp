// The table of the options of a run, and the checks that concern several of them.
#pragma once

#include "simulation/option_set.hpp"
#include <spring_pendulum/simulation/scenario.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {

/// All options of a scenario, in the order in which they are listed to a user, bound to `scenario`.
/// Their values at this time are the defaults that the help text shows.
std::vector<Option> scenarioOptions(Scenario& scenario);

/// Checks what can only be checked when everything is given.
/// \param options where `method` was set, for the message
/// \throws InputError for an unknown method or a run too long to count its steps
void checkScenario(const Scenario& scenario, const OptionSet& options);

/// The given options that the method of the scenario does not use: those of the other kind of
/// stepping.
std::vector<std::string_view> unusedKeys(const Scenario& scenario, const OptionSet& options);

}  // namespace spring_pendulum
