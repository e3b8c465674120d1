// The Taylor series method of order K. In each step, a recursion computes the Taylor coefficients
// of the motion from the state, without truncation error. Their size determines the step size, and
// the series is summed at the end of the step.
//
// A spring with separation d and relative velocity w = d' has the length L, tension T and force f
//
//     L L = d·d      T = k_s (L - rest length) + k_d L'      u = T / L      f = u d
//
// as the elongation rate w·r of the dashpot is L'. These are products of series. With the Cauchy
// product (ab)_n = sum_j a_j b_{n-j}, and the coefficients up to d_{n+1} known, they become (L_0 is
// coefficient 0 of the length)
//
//     L_{n+1} = ((d·d)_{n+1} - sum_{0<j<=n} L_j L_{n+1-j}) / 2 L_0
//     T_n     = k_s (L_n - [n = 0] rest length) + k_d (n+1) L_{n+1}
//     u_n     = (T_n - sum_{j<n} u_j L_{n-j}) / L_0
//     f_n     = sum_{j<=n} u_j d_{n-j}
//     a_n     = (f_n of the right spring - f_n of the left one) / m - [n = 0] g - k_air/m v_n
//     d_{n+2} = (a_n of the right particle - a_n of the left one) / (n+1)(n+2)
//
// K force coefficients give velocities of order K and positions of order K + 1. A step needs one
// square root and one division per spring, otherwise only + - *. The error is known before the step
// size is chosen, so no step is rejected. The series is also the dense output.
//
// The stability function is 1 + z + ... + z^K/K!, stable for imaginary |hλ| <= 3.40 (K = 8) and 3.38
// (K = 12); the limits for real hλ stand below. On the scenes of this package, the method needs less
// time for the same error than any embedded Runge-Kutta pair, at all tolerances, unless particles are
// so light that stability limits the step size.
//
// References: R. E. Moore, Methods and Applications of Interval Analysis, SIAM 1979, section 3.4
// (recursion); Å. Jorba, M. Zou, Exp. Math. 14 (2005) 99-117, doi:10.1080/10586458.2005.10128904
// (choice of the step from the last coefficients).
#pragma once

#include "integration/error_control/dense_output_stepper.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/kernel_data.hpp"
#include "integration/taylor/taylor_expansion.hpp"
#include <spring_pendulum/model/chain.hpp>

#include <cstddef>

namespace spring_pendulum {

/// Stability limits h|λ| for λ on the negative real axis: the zeros of |sum_{n<=K} z^n/n!| - 1.
constexpr double kTaylor8RealStabilityLimit = 4.313627227774381;
constexpr double kTaylor12RealStabilityLimit = 5.8227790681937215;

/// Returns the longest step whose first omitted term is small enough, s; 0 if a coefficient is not finite.
/// \param allowed_rate allowed growth rate of the velocity error, m/s²
double longestAccurateStep(const LastCoefficients& last, std::ptrdiff_t order, double allowed_rate);

class TaylorStepper final : public DenseOutputStepper {
 public:
  /// \param order K in 4..14
  TaylorStepper(const Chain& chain, int order, double tolerance,
                const ChainKernels& kernels = fastestChainKernels());

  void start(const State& state) override;
  double step() override;
  const StateBuffer& stateAt(double fraction) const override;
  StepStatistics statistics() const override { return statistics_; }

 private:
  /// Excludes the end of the chain that falls freely throughout the next step. In one step,
  /// information travels as many springs as the series has coefficients. Changes no bit.
  void skipFreeEnd();
  /// Adds the change of the state until `time` s after `begin_` to `base`.
  const StateBuffer& sumAt(double time, const StateBuffer& base, StateBuffer& out) const;

  Chain chain_;
  double allowed_rate_;  ///< allowed growth rate of the velocity error, m/s²
  const ChainKernels& kernels_;
  KernelConstants constants_;
  TaylorExpansion expansion_;  ///< its size excludes the end that falls freely
  std::ptrdiff_t terms_ = 0;   ///< number of terms summed in the last step
  StateBuffer begin_, end_;
  mutable StateBuffer inside_;
  StateBuffer carry_;  ///< rounding errors of the latest short step
  StepStatistics statistics_;
};

}  // namespace spring_pendulum
