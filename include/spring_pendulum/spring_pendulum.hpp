// Umbrella header: the public interface of the library.
#pragma once

#include <spring_pendulum/base/aligned_numbers.hpp>
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/butcher_tableau.hpp>
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/integration/smallest_tolerance.hpp>
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/io/run_files.hpp>
#include <spring_pendulum/io/scenario_file.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/drive.hpp>
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/model/energy.hpp>
#include <spring_pendulum/model/equilibrium.hpp>
#include <spring_pendulum/model/particles.hpp>
#include <spring_pendulum/model/spring_law.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/energy_balance.hpp>
#include <spring_pendulum/simulation/frame_steps.hpp>
#include <spring_pendulum/simulation/option_list.hpp>
#include <spring_pendulum/simulation/reference_run.hpp>
#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>
#include <spring_pendulum/simulation/stability_advice.hpp>
#include <spring_pendulum/simulation/verdict.hpp>
