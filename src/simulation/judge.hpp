// Judges a run.
//
// Energy and positions are judged after every frame, before it is written. Beyond the energy that its
// drive supplies, a chain never gains energy, whatever its damping: more energy proves an unstable or
// inaccurate integration, even if every number is finite.
//
// The energy balance is E(t) + D(t) - S(t) = E(0), with the energy E = kinetic + gravity + spring, the
// dissipated energy D and the energy S that holders and applied forces have supplied. The residual
// E(t) + D(t) - S(t) - E(0) is the integration error of a quantity whose exact value is known. It is
// given relative to the energy scale: the difference between the larger of E(0) and 0 (all springs
// unstretched and all particles at the height of P_1) and the minimum, the chain hanging at rest, where
// spring i carries the weight W_i of all particles beyond it:
//
//     scale = max(E(0), 0) - E_min ,   E_min = -sum( W_i L_0 + W_i²/(2 k_s) )
//
// The scale is at least the energy of all springs stretched by a millionth of their length. Without
// stiffness (k_s = 0) there is no minimum, and M g² t²/2, the energy of the free fall of the mass M until
// time t, replaces the last term. |S| adds to the scale, which never becomes smaller. Only while they act,
// forces count as weights, and the scale is at least the energy of the chain at the speed of a holder.
#pragma once

#include "simulation/reference_run.hpp"
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/energy.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <cmath>
#include <string>

namespace spring_pendulum {

struct JudgeOptions {
  bool track_dissipation = false;  ///< if not, the residual is known only without damping
  double symplectic_step = 0.0;    ///< s; 0: not symplectic, else the mean energy is judged
  /// Tolerance in m of an error-controlled method; 0 for fixed steps. As position errors of ten tolerances
  /// are allowed, a spring may be 20 too long. That energy is no fault, even if it exceeds the scale.
  double tolerance = 0.0;
  int symplectic_order = 0;  ///< 1: Semi-Implicit-Euler, 2: Velocity-Verlet, 0: any other method
};

/// Judges the frames of a run and keeps the worst verdict.
class Judge {
 public:
  static constexpr double kDriftThreshold = 0.01, kGainThreshold = 0.01;
  static constexpr double kDivergenceThreshold = 1.0;
  /// In units of `ReferenceRun::length`. Smaller errors are not visible in a picture of the chain.
  static constexpr double kInaccurateThreshold = 0.01;

  /// \param start_time s
  /// \throws InputError if an energy of the start exceeds the range of double
  Judge(const Chain& chain, const State& start, const JudgeOptions& options, double start_time = 0);

  /// Judges the state at `time` s by its energy and its positions.
  /// \param dissipated `Integrator::dissipatedEnergy()`, J; used only if tracked
  /// \param reference  at the same time, measured; null: none
  /// \param supplied   `Integrator::suppliedEnergy()`, J
  const Verdict& judge(double time, const State& state, double dissipated,
                       const ReferenceRun* reference, double supplied = 0.0);

  /// Continues with another chain of as many particles, and from another state.
  /// \param options  `track_dissipation`: whether the dissipated energy is known from the start on
  /// \param supplied energy supplied before the change, J
  /// \param has_moved whether the chain has moved since the change before
  /// \returns the energy supplied until after the change, J: it includes the difference of the energies
  /// \throws InputError if an energy exceeds the range of double; the judge is not valid then
  double change(const Chain& chain, const State& before, const State& after,
                const JudgeOptions& options, double supplied, bool has_moved);

  /// Returns the energy balance of a state; arguments as of `judge`.
  EnergyEntry balanceOf(double time, const State& state, double dissipated,
                        double supplied = 0.0) const;
  double scale(double time, double supplied = 0.0) const;  ///< J, without hands and forces

  const EnergyEntry& entry() const { return entry_; }  ///< of the last judged state
  const PositionError& positionError() const { return position_error_; }
  double largestEnergyError() const { return entry_.residual ? worst_residual_ : std::nan(""); }
  bool isShown(bool continues_after_divergence) const;  ///< as Run::isShown, of the last frame
  const Verdict& worst() const { return worst_; }       ///< the first of the most severe so far

  std::string measurements() const;     ///< as Run::measurements
  std::string toleranceRemark() const;  ///< as Run::toleranceRemark

 private:
  /// Returns the energy of a state, with the height of P_1 at the start as height 0 of all states.
  Energy energyOf(const State& state) const;
  void measureChain(const State& state, double energy, double time);
  void measure(const State& state, const ReferenceRun* reference);
  /// Returns the energy minus two modified ones, J. With the forces f of springs and gravity, a symplectic method
  /// conserves E + h/2 f·v (Semi-Implicit-Euler) or E - h²/8 f²/m (Velocity-Verlet) if the chain is linear, and if
  /// it is not, but for terms of higher order, this plus h²/12 (f²/m + v·K v) with the stiffness matrix K.
  /// Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, 2nd ed., 2006, section IX.3.
  Eigen::Array2d oscillationOf(const State& state) const;
  Verdict energyVerdict(double time, const State& state, double supplied, bool is_measuring);
  Verdict positionVerdict(const ReferenceRun* reference) const;

  Chain chain_;
  JudgeOptions options_;
  bool changed_ = false;
  double start_energy_;                  ///< J
  double start_height_;                  ///< of P_1, m
  double still_scale_ = 0.0;             ///< without fall and supplied energy, J
  double fall_ = 0.0, fall_time_ = 0.0;  ///< J/s² since this time, s
  double pulled_depth_ = 0.0;            ///< by which forces lower the energy at rest, J
  double largest_scale_ = 0.0;           ///< at which the chain has moved, J
  Eigen::Array2d oscillation_;           ///< at the start, J, and its jumps since then
  double mean_time_;                     ///< since when the mean is judged, s
  /// Since then: relative gain, residual, its error, two changes of the modified energies, and one each frame.
  Eigen::Array<double, 6, 1> sums_ = Eigen::Array<double, 6, 1>::Zero();
  double dissipated_error_ = 0.0;  ///< J, when it was measured last
  double worst_residual_ = 0.0;    ///< largest relative residual of the energy balance
  // Remarks, empty as long as the error does not exceed ten tolerances.
  std::string exceeded_;   ///< where other methods keep the tolerance
  std::string sensitive_;  ///< where none can promise it
  EnergyEntry entry_;
  PositionError position_error_;
  Verdict latest_, worst_;
};

}  // namespace spring_pendulum
