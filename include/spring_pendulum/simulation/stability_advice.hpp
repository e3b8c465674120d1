// Advice on the step size, from trial runs.
//
// Most runs take milliseconds, so `--check` performs the run, measures its position error against a
// reference run and its energy balance, and searches for the largest step size that passes. The
// work of a trial is bounded by nominal computing time (Integrator::work), not by a clock.
//
// A chain too large for a trial gets the stability limit of its linearised motion instead. The limit
// follows from the stability function of the method at the eigenvalues of the fastest mode, and of
// the slowest one if the method is unstable without damping.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/scenario.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <functional>
#include <limits>
#include <string>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Step sizes in s; 0 if the smallest affordable one fails, infinite if all pass.
struct StepLimits {
  double stable = 0.0;    ///< largest without divergence or energy gain; NaN if too long to find
  double accurate = 0.0;  ///< largest without a bad verdict (isBad); NaN if a reference run, which
                          ///< this takes, would take too long
};

/// Finds the limits of a fixed-step method within 2 % by trial runs, with three significant digits.
/// Every smaller step size tried passes, too.
/// \param first          first step size to try, s
/// \param duration       duration of the run, s
/// \param frame_interval time between frames, s
/// \throws InputError if the method is error-controlled, or a time is not finite and positive
StepLimits findStepLimits(const Method& method, const Chain& chain, const State& start,
                          double first, double duration, double frame_interval);

/// Largest stable step size in s of the linearised chain, with a margin; infinite without springs
/// and for error-controlled methods, 0 if none is known.
double linearStepLimit(const Method& method, const Chain& chain, double duration);

/// What `--check` finds out.
struct StabilityReport {
  std::string text;              ///< that `--check` prints: one or more lines
  bool tried = false;            ///< whether the run was tried; if not, the next two are unset
  Verdict verdict;               ///< on the trial
  PositionError position_error;  ///< of the trial
  /// Of a fixed-step method. If the run takes too long to be tried, `stable` is `linearStepLimit`. NaN
  /// if not known, and for error-controlled methods.
  StepLimits limits = {std::numeric_limits<double>::quiet_NaN(),
                       std::numeric_limits<double>::quiet_NaN()};
};

/// Tries a run and finds the largest step sizes.
/// \param stop asked during the trials; when it returns true, the report is incomplete
/// \throws InputError for a value of the scenario out of its range
StabilityReport checkStability(const Chain& chain, const State& start, const Scenario& scenario,
                               const std::function<bool()>& stop = {});

/// One line if the time step is clearly above the stability limit of the method, whatever the
/// positions of the particles; else empty. O(N), negligible compared with a run.
/// \param start if not null, the first steps of the run are tried as well, for about 0.02 s
std::string stabilityWarning(const Chain& chain, const Scenario& scenario,
                             const State* start = nullptr);

/// One line with a remedy for a motion that diverged.
/// \param stop asked during the trials; when it returns true, the result is empty
/// \throws InputError for a value of the scenario out of its range
std::string remedyForDivergence(const Chain& chain, const State& start, const Scenario& scenario,
                                const std::function<bool()>& stop = {});

}  // namespace spring_pendulum
#pragma GCC visibility pop
