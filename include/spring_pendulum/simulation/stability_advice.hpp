// Advice on the step size: what --check prints.
//
// There is one largest stable step size: that of the linearised motion, confirmed by a run with it and a
// run with a slightly larger step size, and corrected by bisection if they disagree. A chain too large
// for trial runs gets the linear limit with a margin. The work of trials is counted, not timed.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/plan.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <functional>
#include <limits>
#include <string>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// The largest step size without divergence or energy gain.
struct StableStep {
  /// s, with three significant digits; infinite if the whole run may be one step; 0 if not known; NaN for
  /// error-controlled methods.
  double step = std::numeric_limits<double>::quiet_NaN();
  bool is_estimate = false;  ///< whether this is the linear limit because runs take too long
};

/// What `--check` finds out.
struct StabilityReport {
  std::string text;              ///< that `--check` prints: one or more lines
  bool tried = false;            ///< whether the run was tried; if not, the next two are unset
  Verdict verdict;               ///< on the trial
  PositionError position_error;  ///< of the trial
  StableStep stable;
  /// Largest step size in s without a bad verdict (isBad); 0 if none could be tried. NaN if not known,
  /// and for error-controlled methods.
  double accurate_step = std::numeric_limits<double>::quiet_NaN();
};

/// Returns a step size in s at which the linearised chain is stable with a margin, whatever its shape;
/// infinite without springs and for error-controlled methods, 0 if none is known. O(N).
/// \param duration of the run, s. The energy of a mode may grow during the run by as much as a verdict
///   allows.
double linearStepLimit(const Method& method, const Chain& chain, double duration);

/// Returns the largest stable step size of a run, from a few trial runs. Independent of
/// `Plan::time_step`, except that it determines the duration.
/// \param stop asked during the trials; when it returns true, the result is not valid
/// \throws InputError for a value of the plan out of its range, as the functions below
StableStep largestStableStep(const Chain& chain, const State& start, const Plan& plan,
                             const std::function<bool()>& stop = {});

/// Tries a run and finds the largest step sizes.
/// \param start positions and velocities of the particles
StabilityReport checkStability(const Chain& chain, const State& start, const Plan& plan,
                               const std::function<bool()>& stop = {});

/// Returns one line if the time step is clearly above the stability limit of the method, whatever the
/// positions of the particles; else an empty string. O(N) if it is empty.
std::string stabilityWarning(const Chain& chain, const State& start, const Plan& plan);

/// Returns one line with a remedy for a motion that diverged; empty if it was stopped.
std::string remedyForDivergence(const Chain& chain, const State& start, const Plan& plan,
                                const std::function<bool()>& stop = {});

}  // namespace spring_pendulum
#pragma GCC visibility pop
