// Advice before the first step: which step will this motion bear?
//
// A step holds if no mode of the linearised chain gains more energy in the whole run than the
// verdict allows. The modes are those of model/chain_modes.hpp; what the method makes of each is
// measured (mode_response.hpp), so its full stability region counts, not only the limits on the
// axes. Three things go beyond the linear chain at rest:
// - in motion the springs pull harder than at rest: three times the tension is allowed for;
// - springs that start stretched may gain energy before they lose it, also with a stable method;
// - a method that lets undamped modes grow (Euler, Runge-Kutta-2) lets the swinging grow, as a
// share
//   of what it would do to an undamped spring: (slow swing / fastest spring)², counted over four
//   swings at least. The springs damp fast swinging in turn, by a coupling that no linear analysis
//   sees. So for these methods the advice is on the safe side, and exact only where the springs
//   decide.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <string>

namespace spring_pendulum {

struct StabilityAdvice {
  double spring_step = 0.0;   ///< s, largest step the modes of springs and tension bear
  double swing_step = 0.0;    ///< s, largest step that surely does not swing the chain up
  double swing_growth = 0.0;  ///< energy of the slow swing at the end over that at the start

  /// s; infinite for methods that bear any step or choose their own.
  double largestStep() const { return spring_step < swing_step ? spring_step : swing_step; }
};

/// \param time_step s, for `swing_growth`
/// \param duration  of the run, s
StabilityAdvice adviseOnStability(const Method& method, const Chain& chain, const State& start,
                                  double time_step, double duration);

/// A method that holds with the scenario's frames: of those with a fixed step that bear `time_step`
/// without letting the swinging grow the one of fewest stages, else an error-controlled one; empty
/// if there is none.
std::string methodThatHolds(const Chain& chain, const State& start, const Scenario& scenario);

/// What `--check` prints: one or several lines.
std::string describeStability(const Chain& chain, const State& start, const Scenario& scenario);

/// A line of warning if the run is not going to hold, else empty.
std::string warnOfInstability(const Chain& chain, const State& start, const Scenario& scenario);

/// What to do about a motion that diverged, one line.
std::string remedyForDivergence(const Chain& chain, const State& start, const Scenario& scenario);

}  // namespace spring_pendulum
