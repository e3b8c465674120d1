// Settings of the integrator for a scenario, and the work that a run skips.
#pragma once

#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <string>

namespace spring_pendulum {

/// Returns the options of the integrator for a scenario.
IntegratorOptions integratorOptions(const Scenario& scenario, bool track_dissipation);

/// Returns the cost of a force evaluation, in force evaluations of Taylor-8. Measured for
/// fixed-step methods: 0.36 with 2 particles, 0.4 with 11, 0.7 with 50, 1.1 with 100, 2.1 with 300.
double workPerEvaluation(const Method& method, Eigen::Index particles);

/// Returns a line "skipped: ..." for each kind of work that a run skips because its scenario does
/// not need it.
std::string skippedWork(const Scenario& scenario, const Integrator& integrator,
                        bool tracks_dissipation);

}  // namespace spring_pendulum
