// Advice on the step size: a run is tried, and what happened is reported.
//
// A trial costs milliseconds, so `--check` makes the run that it speaks of, measures its position
// error against a reference run and its energy balance, and searches for the largest step size that
// still passes. The work of a trial is bounded by a count, not by a clock.
//
// A chain too large to be tried gets the stability limit of its linearised motion, which is found
// by trying a single spring that is as fast as the chain's fastest mode, and a pendulum as slow as
// the chain.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/export.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <string>

namespace SPRING_PENDULUM_API spring_pendulum {

/// Step sizes in s; 0 where even the smallest affordable one fails, infinite where all pass.
struct StepLimits {
  double stable = 0.0;    ///< largest without divergence or gain of energy
  double accurate = 0.0;  ///< largest whose verdict does not blame the run (isBad)
};

/// Finds the limits of a fixed-step method by trying, within 2 %: every smaller step size that was
/// tried passed too.
/// \param first          step size in s to start at
/// \param duration       of the run, s
/// \param frame_interval s
StepLimits findStepLimits(const Method& method, const Chain& chain, const State& start,
                          double first, double duration, double frame_interval);

/// Largest stable step size in s of the linearised chain with a margin; infinite without springs.
double linearStepLimit(const Method& method, const Chain& chain, double duration);

/// What `--check` prints: one or several lines.
std::string describeStability(const Chain& chain, const State& start, const Scenario& scenario);

/// What to do about a motion that diverged, one line.
std::string remedyForDivergence(const Chain& chain, const State& start, const Scenario& scenario);

}  // namespace spring_pendulum
