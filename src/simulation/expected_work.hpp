// A guess of what a run costs, made before it starts.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

namespace spring_pendulum {

/// Expected work of a run without its reference run, s; see Integrator::work.
double expectedWork(const Scenario& scenario, const Chain& chain);

}  // namespace spring_pendulum
