// Stability of a method on the linearised motion of a chain.
//
// Every mode of the chain obeys q'' + c q' + k q = 0. One step of size h multiplies the mode by the
// stability function R(hλ) of the method, where λ² + c λ + k = 0.
//
// Reference: Hairer, Wanner, Solving Ordinary Differential Equations II, 2nd ed., 1996, section IV.2.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/chain.hpp>

namespace spring_pendulum {

/// Returns ln |R|, the growth of a mode in one step: above 0 if the method is unstable.
///
/// Exact for explicit Runge-Kutta, Taylor and symplectic methods; one that is stable everywhere counts as exact.
/// \param swing h sqrt(k)
/// \param decay h c
double growthPerStep(const Method& method, double swing, double decay);

/// Returns the largest stable step size in s of the springs alone, in a run of `duration` s: of the fastest mode.
double springStepLimit(const Method& method, const Chain& chain, double duration);

/// Whether the oscillation of the stiffest spring alone grows by a factor of 1e8 within the run and
/// 500 steps, even at 0.6 times the time step. Then the chain is unstable in every shape. O(N).
bool isClearlyUnstable(const Method& method, const Chain& chain, double time_step, double duration);

}  // namespace spring_pendulum
