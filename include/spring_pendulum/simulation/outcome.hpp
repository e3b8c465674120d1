// What a run has to tell: before, after, and on request (--check). Every program says the same.
//
// There is one largest stable step size: that of the linearised motion, confirmed by a run with it and a
// run with a slightly larger step size, and corrected by bisection if they disagree. A chain too large
// for trial runs gets the linear limit with a margin. The work of trials is counted, not timed.
#pragma once

#include <spring_pendulum/simulation/run.hpp>

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// What a program says before a run.
struct Remarks {
  std::vector<std::string> notes;  ///< much memory is needed, gravity points up
  std::string warning;             ///< the step size is too large; empty if it is not
};

Remarks remarksOn(const Run& run);

/// What a program says after a run.
struct Outcome {
  int status = 0;  ///< exit status of the program: 0, or 3 if the motion has diverged
  /// Warnings; after a divergence one line instead: when, where, a remedy.
  std::vector<std::string> lines;
};

/// \param stop asked while a remedy for a divergence is sought; when it returns true, there is none
Outcome outcomeOf(const Run& run, const std::function<bool()>& stop = {});

/// The largest step size without divergence or energy gain.
struct StableStep {
  /// s, in three digits; infinite: the whole run; 0: not known; NaN: of error-controlled methods.
  double step = std::numeric_limits<double>::quiet_NaN();
  bool is_estimate = false;  ///< whether this is the linear limit because runs take too long
};

/// What `--check` finds out.
struct StabilityReport {
  std::string text;                ///< that `--check` prints: one or more lines
  std::optional<Verdict> verdict;  ///< on the trial; none: the run takes too long to be tried
  double position_error = std::numeric_limits<double>::quiet_NaN();  ///< largest of the trial, m
  StableStep stable;
  /// Largest step size in s without a bad verdict until the motion is sensitive; 0: none found; NaN: unknown.
  double accurate_step = std::numeric_limits<double>::quiet_NaN();
};

/// Returns a step size in s at which the linearised chain is stable with a margin, whatever its shape;
/// infinite without springs and for error-controlled methods, 0 if none is known. O(N).
/// \param duration of the run, s, in which the energy of a mode may grow by as much as a verdict allows
double linearStepLimit(const Method& method, const Chain& chain, double duration);

/// Returns the largest stable step size of a run, from trial runs as long as that with `Plan::time_step`.
/// \param stop asked during the trials; when it returns true, the result is not valid
/// \throws InputError for a value of the plan out of its range or a driven chain, as the functions below
StableStep largestStableStep(const Chain& chain, const State& start, const Plan& plan,
                             const std::function<bool()>& stop = {});

/// Tries a run and finds the largest step sizes.
StabilityReport checkStability(const Chain& chain, const State& start, const Plan& plan,
                               const std::function<bool()>& stop = {});

/// Returns one line if the step is clearly above the stability limit; else, and if driven, an empty string.
std::string stabilityWarning(const Chain& chain, const State& start, const Plan& plan);

/// Returns one line with a remedy for a motion that diverged; empty if it was stopped.
std::string remedyForDivergence(const Chain& chain, const State& start, const Plan& plan,
                                const std::function<bool()>& stop = {});

}  // namespace spring_pendulum
#pragma GCC visibility pop
