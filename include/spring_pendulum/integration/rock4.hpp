// ROCK4: explicit, order 4, stabilised along the negative real axis.
//
// The rates of a damped chain lie near the negative real axis and reach -k_d/m. Instead of raising
// the order, this method spends stages on stability: s of them let h|λ| reach 0.35 s² there, where
// Runge-Kutta-4 reaches 2.8 with four. A step takes as many stages as its length needs, from 5 to
// 30. Undamped swinging is stable up to hω = 3.2.
//
//     s             5     6     8    10    14    20    30
//     limit h|λ|    6.0   9.8   20    32    65   136   310
//
// Take it for light particles at coarse and medium tolerances: it is the cheapest method wherever
// damping, not accuracy, limits plain explicit steps. The dense output is a cubic, order 3.
//
// Reference: A. Abdulle, SIAM J. Sci. Comput. 23 (2002) 2041-2054, doi:10.1137/S1064827500379549;
// coefficients derived anew, see rock4_coefficients.hpp.
#pragma once

#include <spring_pendulum/integration/controlled_stepper.hpp>
#include <spring_pendulum/integration/rock4_coefficients.hpp>

#include <array>

namespace spring_pendulum {

class Rock4Stepper final : public ControlledStepper {
 public:
  /// Part of the tolerance that the error of a step may have, measured on the reference scenes:
  /// with the first the position error is at most 7.2 tolerances on all of them for tolerances down
  /// to 1e-8 m, after 50 s of the weakly chaotic `horizontal_11` too, where below that the rounding
  /// of so many steps shows (11 at 1e-9 m, 25 at 1e-10 m). The second will do for the stiff scenes.
  static constexpr double kShareOfTolerance = 8e-6;
  static constexpr double kShareOfToleranceIfStiff = 1.5e-4;

  Rock4Stepper(const Chain& chain, const IntegratorOptions& options,
               double share_of_tolerance = kShareOfTolerance);

  void interpolate(double fraction, State& state) const override;

 private:
  void prepare(bool restarted) override;
  /// Also picks the number of stages for it.
  double admissible(double h) override;
  double attempt(double h) override;
  /// \returns K_n
  const StateBuffer& runRecurrence(double h);
  void computeSlope(const StateBuffer& state, SlopeSum sum, StateBuffer& slope);

  double fastest_rate_;  ///< bound of |λ| of the damped modes, 1/s
  const Rock4Coefficients* method_;
  StateBuffer first_slope_;            ///< F(z_n)
  std::array<StateBuffer, 2> inner_;   ///< K_{j-1} and K_{j-2}
  std::array<StateBuffer, 5> slopes_;  ///< f_i
};

}  // namespace spring_pendulum
