// How a scenario is to be worked on: what the integrator is told, and what need not be done.
#pragma once

#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <string>
#include <vector>

namespace spring_pendulum {

IntegratorOptions integratorOptions(const Scenario& scenario, bool track_dissipation);

/// What a run of this scenario leaves out because nobody needs it, one line each.
std::vector<std::string> skippedWork(const Scenario& scenario, const Integrator& integrator,
                                     bool tracks_dissipation);

}  // namespace spring_pendulum
