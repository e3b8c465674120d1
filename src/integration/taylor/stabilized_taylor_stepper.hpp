// The Taylor series method with weights on its higher terms, which extend the stability limit.
//
// The eigenvalues λ of a damped chain lie near the negative real axis, down to about -4 k_d/m. On
// this axis, the plain series with K terms is stable only up to about h|λ| = 0.4 K. Here, the terms
// above the order p are weighted,
//
//     z(t+h) = sum_j w_j c_j h^j ,    w_j = 1 up to order p ,    R(z) = sum_j w_j z^j / j! ,
//
// with the weights that keep |R| <= 0.95 as far out as possible (stabilized_polynomials.hpp):
//
//     order 4, terms     4      5      6      7      8      9     10
//     limit h|λ|        2.8    6.0    9.9   14.4   19.7   25.7   32.4
//     order 8, terms     8      9     10     11     12     13     14
//     limit h|λ|        4.3    7.1   10.1   13.4   17.1   21.0   25.4
//
// Each step uses as many terms as its size needs. The error estimate is another weighted sum, of
// order p - 1, that stays small for fast modes. It includes velocity errors, times 1/rate of the
// fastest mode: in a vibration, the position error alone vanishes twice per period. Undamped
// oscillation is stable up to hω = 2.8 (order 4) and 3.4 (order 8). The dense output is the series
// with the weights of the step and has order p throughout the step.
//
// Use this method if light particles and damping make the steps of other explicit methods short and
// errors of 1e-3 m to 1e-10 m are wanted. It then needs a quarter to a tenth of their work,
// including that of the stabilised Runge-Kutta method ROCK4. For very light particles, use Radau-9.
// More terms would extend the limit further, but rounding errors grow like exp(h|λ|) within a step.
//
// References: D. I. Ketcheson, A. J. Ahmadia, Commun. Appl. Math. Comput. Sci. 7 (2012) 247-271,
// doi:10.2140/camcos.2012.7.247 (optimal polynomials); taylor_stepper.hpp (the series).
#pragma once

#include "integration/error_control/error_estimating_stepper.hpp"
#include "integration/taylor/stabilized_polynomials.hpp"
#include "integration/taylor/taylor_expansion.hpp"

#include <initializer_list>

namespace spring_pendulum {

class StabilizedTaylorStepper final : public ErrorEstimatingStepper {
 public:
  /// Largest estimated error of a step, in tolerances. With this value, the position error is at
  /// most 3.5 tolerances on the reference scenes: after 50 s of the weakly chaotic `horizontal_11`.
  static constexpr double kShareOfTolerance = 5e-5;

  /// \param order 4 or 8
  StabilizedTaylorStepper(const Chain& chain, int order, double tolerance,
                          const ChainKernels& kernels = fastestChainKernels());

 private:
  void prepare(bool restarted) override;
  /// Also selects the number of terms for the step.
  double admissible(double h) override;
  double attempt(double h) override;
  const StateBuffer& stateInside(double fraction) const override {
    return sumAt(fraction * statistics_.last_step);
  }
  /// Returns the state `time` s after `begin_`.
  const StateBuffer& sumAt(double time) const;

  double least_time_per_error_;    ///< s; shorter steps limit the error per time
  double fastest_rate_;            ///< upper bound of |λ| of the damped modes, 1/s
  double time_of_velocity_error_;  ///< s; position error = this x velocity error
  std::initializer_list<StabilizedPolynomial> polynomials_;
  const StabilizedPolynomial* polynomial_;
  TaylorExpansion expansion_;
  int known_terms_ = 0;  ///< number of computed terms of the expansion about `begin_`
  StateBuffer change_;   ///< change of the state in the step
  mutable StateBuffer inside_;
};

}  // namespace spring_pendulum
