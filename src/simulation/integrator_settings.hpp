// Settings of the integrator for a scenario, and the work that a run skips.
#pragma once

#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <string>
#include <vector>

namespace spring_pendulum {

/// Returns the options of the integrator for a scenario.
IntegratorOptions integratorOptions(const Scenario& scenario, bool track_dissipation);

/// Work of a force evaluation of a method, in those of Taylor-8. Measured for the fixed-step methods:
/// 0.36 for 2 particles, 0.4 for 11, 0.7 for 50, 1.1 for 100, 2.1 for 300.
double workPerEvaluation(const Method& method, Eigen::Index particles);

/// What a run of this scenario leaves out because nobody needs it, one line each.
std::vector<std::string> skippedWork(const Scenario& scenario, const Integrator& integrator,
                                     bool tracks_dissipation);

}  // namespace spring_pendulum
