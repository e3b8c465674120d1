// Advice on the step size, from trial runs.
//
// A trial takes milliseconds, so `--check` performs the run, measures its position error against a
// reference run and its energy balance, and searches for the largest step size that passes. The
// work of a trial is bounded by a number of force evaluations, not by a clock.
//
// For a chain too large for a trial, the advice is the stability limit of the linearised motion. It
// is found by trial runs of a single spring with the rate of the fastest mode of the chain, and of
// a pendulum with the frequency of its slowest mode.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <string>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Step sizes in s; 0 if the smallest affordable one fails, infinite if all pass.
struct StepLimits {
  double stable = 0.0;    ///< largest without divergence or energy gain
  double accurate = 0.0;  ///< largest without a bad verdict (isBad); NaN if a reference run, which
                          ///< this takes, would take too long
};

/// Finds the limits of a fixed-step method within 2 % by trial runs. Every smaller step size tried
/// passes, too.
/// \param first          first step size to try, s
/// \param duration       duration of the run, s
/// \param frame_interval time between frames, s
StepLimits findStepLimits(const Method& method, const Chain& chain, const State& start,
                          double first, double duration, double frame_interval);

/// Largest stable step size in s of the linearised chain, with a margin; infinite without springs.
double linearStepLimit(const Method& method, const Chain& chain, double duration);

/// The text that `--check` prints: one or more lines.
std::string describeStability(const Chain& chain, const State& start, const Scenario& scenario);

/// One line with a remedy for a motion that diverged.
std::string remedyForDivergence(const Chain& chain, const State& start, const Scenario& scenario);

}  // namespace spring_pendulum
#pragma GCC visibility pop
