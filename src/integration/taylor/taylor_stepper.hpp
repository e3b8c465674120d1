// The Taylor series method of order K: from the state alone the motion's first derivatives are
// computed exactly, by recursion, and the series is summed at a step of its own choice.
//
// For a spring with separation d and approach w = d' the length L, the tension T and the force are
//
//     L L = d·d      T = k_s (L - L_0) + k_d L'      u = T / L      f = u d
//
// because the dashpot's rate w·r is the change of length L'. Each line is a product of series, so
// with (ab)_n = sum_j a_j b_{n-j} and the coefficients up to d_{n+1} known:
//
//     L_{n+1} = ((d·d)_{n+1} - sum_{0<j<=n} L_j L_{n+1-j}) / 2 L_0          (here L_0, T_0, ... are
//     T_n     = k_s (L_n - [n = 0] rest length) + k_d (n+1) L_{n+1}          coefficients number 0)
//     u_n     = (T_n - sum_{j<n} u_j L_{n-j}) / L_0
//     f_n     = sum_{j<=n} u_j d_{n-j}
//     a_n     = (f_n of the right spring - f_n of the left one) / m - [n = 0] g
//     d_{n+2} = (a_n of the right particle - a_n of the left one) / (n+1)(n+2)
//
// Forces of K coefficients give velocities right to order K and positions to order K + 1. One root
// and one division a spring and step are all that is not + - *; no step is ever rejected, because
// its error is known before its length is chosen; and the series is the dense output.
//
// The linear stability function is 1 + z + ... + z^K/K!. On the scenes of this package it needs
// less time for the same error than any Runge-Kutta pair, at all tolerances, unless particles are
// so light that stability and not accuracy limits the step.
//
// References: R. E. Moore, Methods and Applications of Interval Analysis, SIAM 1979, section 3.4
// (recursion); Å. Jorba, M. Zou, Exp. Math. 14 (2005) 99-117, doi:10.1080/10586458.2005.10128904
// (choice of the step from the last coefficients).
#pragma once

#include "integration/error_control/dense_output_stepper.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/state_buffer.hpp"
#include "integration/taylor/taylor_expansion.hpp"
#include <spring_pendulum/model/chain.hpp>

namespace spring_pendulum {

/// Largest h|λ| for λ on the negative real axis: the zero of |sum_{n<=K} z^n/n!| - 1.
constexpr double kTaylor8RealStabilityLimit = 4.313627227774381;
constexpr double kTaylor12RealStabilityLimit = 5.8227790681937215;

class TaylorStepper final : public DenseOutputStepper {
 public:
  /// \param order K in 4..14
  TaylorStepper(const Chain& chain, int order, double tolerance,
                const ChainKernels& kernels = fastestChainKernels());

  void start(const State& state) override;
  double step() override;
  void interpolate(double fraction, State& state) const override;
  StepStatistics statistics() const override { return statistics_; }

  /// Takes a step of this length, whatever its error: what the order is measured with.
  void stepBy(double h);

 private:
  /// Whether a spring pulls at neither end, and will not until its neighbours do: exactly of its
  /// rest length, level, with both ends falling alike.
  bool fallsFreely(Eigen::Index spring) const;
  /// Leaves out the end of the chain that nothing but gravity moves in this step. In one step
  /// information travels as many springs as the series has coefficients. Changes no bit.
  void skipFreeEnd();
  void expand();
  void sumSeries(double h, std::ptrdiff_t terms);
  void sumAt(double time, StateBuffer& out) const;
  double longestAccurateStep();

  Chain chain_;
  double allowed_rate_;  ///< of the error of the velocities, m/s²
  const ChainKernels& kernels_;
  TaylorExpansion expansion_;
  TaylorWorkspace& work_;     ///< of the part of the chain that is not left out
  std::ptrdiff_t terms_ = 0;  ///< summed in the last step
  StateBuffer begin_;
  StateBuffer end_;
  mutable StateBuffer inside_;
  StepStatistics statistics_;
};

}  // namespace spring_pendulum
