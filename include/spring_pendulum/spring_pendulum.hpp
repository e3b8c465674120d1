// Umbrella header: the public interface of the library.
#pragma once

#include <spring_pendulum/base/aligned_numbers.hpp>
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/butcher_tableau.hpp>
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/io/run_files.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/model/energy.hpp>
#include <spring_pendulum/model/scene.hpp>
#include <spring_pendulum/model/spring_law.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/option.hpp>
#include <spring_pendulum/simulation/outcome.hpp>
#include <spring_pendulum/simulation/plan.hpp>
#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>
#include <spring_pendulum/simulation/verdict.hpp>
