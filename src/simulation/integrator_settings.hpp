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

/// Work of a force evaluation relative to Taylor-8. Measured for the fixed-step methods: 0.36 for 2 particles, 0.4 for 11, 0.7 for 50, 1.1 for 100, 2.1 for 300.
double workPerEvaluation(const Method& method, Eigen::Index particles);

/// Returns a line for each kind of work that a run skips because its scenario does not need it.
std::vector<std::string> skippedWork(const Scenario& scenario, const Integrator& integrator,
                                     bool tracks_dissipation);

}  // namespace spring_pendulum
