// Embedded explicit Runge-Kutta pairs: a tableau of order p, weights of the difference to an
// embedded method of lower order, and a polynomial for the state inside a step (dense output).
//
//     z_{n+1} = z_n + h sum b_i k_i
//     error = h sum e_i k_i
//     z(t_n + θh) = z_n + h sum b_i(θ) k_i
//
// The slope at the end of a step, k_s = F(z_{n+1}), is the first slope of the next step. The dense output uses
// it, too; it is numbered like a stage.
//
// The error is controlled per step and in the maximum norm, so that particles at rest do not dilute
// the error of a moving one. The solution of higher order is continued (local extrapolation), which
// makes the global error proportional to the tolerance.
//
// Reference: E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd
// ed., Springer 1993, sections II.4 to II.6.
#pragma once

#include "integration/error_control/error_estimating_stepper.hpp"
#include <spring_pendulum/integration/butcher_tableau.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace spring_pendulum {

struct EmbeddedPair {
  static constexpr std::size_t kMaxDegree = 4;
  using Weights = std::array<double, ButcherTableau::kMaxStages>;

  ButcherTableau tableau;
  Weights error{};  ///< e_i
  /// b_i(θ) = sum over d of dense[i][d] θ^(d+1)
  std::array<std::array<double, kMaxDegree>, ButcherTableau::kMaxStages> dense{};

  /// b_i(θ) of the dense output, for all stages and k_s.
  Weights denseWeights(double theta) const {
    Weights weights{};
    for (std::size_t i = 0; i <= tableau.stages; ++i) {
      for (std::size_t d = kMaxDegree; d-- > 0;) weights[i] = theta * (dense[i][d] + weights[i]);
    }
    return weights;
  }
};

/// Dormand-Prince 5(4): six stages, order 5, dense output of order 4 without extra slopes. Stable for
/// real hλ >= -3.31 and imaginary |hλ| <= 0.997.
///
///     0    |
///     1/5  | 1/5
///     3/10 | 3/40        9/40
///     4/5  | 44/45       -56/15       32/9
///     8/9  | 19372/6561  -25360/2187  64448/6561  -212/729
///     1    | 9017/3168   -355/33      46732/5247  49/176    -5103/18656
///     -----+------------------------------------------------------------------
///          | 35/384      0            500/1113    125/192   -2187/6784   11/84
///
/// J. R. Dormand, P. J. Prince, J. Comput. Appl. Math. 6 (1980) 19-26,
/// doi:10.1016/0771-050X(80)90013-3; dense output as in Hairer's DOPRI5, section II.6.
inline constexpr EmbeddedPair kDormandPrince5{
    {6,
     {{{},
       {1.0 / 5.0},
       {3.0 / 40.0, 9.0 / 40.0},
       {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0},
       {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0},
       {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0}}},
     {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0}},
    {71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0,
     -1.0 / 40.0},
    {{{1.0, -8048581381.0 / 2820520608.0, 8663915743.0 / 2820520608.0,
       -12715105075.0 / 11282082432.0},
      {},
      {0.0, 131558114200.0 / 32700410799.0, -68118460800.0 / 10900136933.0,
       87487479700.0 / 32700410799.0},
      {0.0, -1754552775.0 / 470086768.0, 14199869525.0 / 1410260304.0,
       -10690763975.0 / 1880347072.0},
      {0.0, 127303824393.0 / 49829197408.0, -318862633887.0 / 49829197408.0,
       701980252875.0 / 199316789632.0},
      {0.0, -282668133.0 / 205662961.0, 2019193451.0 / 616988883.0, -1453857185.0 / 822651844.0},
      {0.0, 40617522.0 / 29380423.0, -110615467.0 / 29380423.0, 69997945.0 / 29380423.0}}}};

class EmbeddedRungeKuttaStepper final : public ErrorEstimatingStepper {
 public:
  EmbeddedRungeKuttaStepper(const Chain& chain, double tolerance,
                            const ChainKernels& kernels = fastestChainKernels());

 private:
  void prepare(bool restarted) override;
  double attempt(double h) override;
  const StateBuffer& stateInside(double fraction) const override;

  std::vector<StateBuffer> slopes_;
  mutable StateBuffer inside_;
};

}  // namespace spring_pendulum
