// Judges a run.
//
// Energy and positions are judged after every frame, before it is written. Beyond the energy that its
// drive supplies, a chain never gains energy, whatever its damping. So an energy above that of the
// start proves an unstable or inaccurate integration, even if every number is finite. A reference run,
// if there is one, gives the position error. If the energy balance is off, it also shows whether the
// energy or only the dissipated energy is wrong.
#pragma once

#include "simulation/energy_balance.hpp"
#include "simulation/reference_run.hpp"
#include <spring_pendulum/simulation/verdict.hpp>

#include <string>

namespace spring_pendulum {

struct JudgeOptions {
  bool track_dissipation = false;  ///< whether the integrator has it set
  /// Step size in s of a symplectic method; 0 for other methods. The energy of a symplectic method
  /// oscillates about its true value, so its mean error over the run so far is judged.
  double symplectic_step = 0.0;
  /// Tolerance in m of an error-controlled method; 0 for fixed steps. The method promises position
  /// errors of at most ten tolerances, which change the length of a spring by up to 20. The energy of
  /// this change is no fault: for particles of 1e-9 kg it exceeds the energy scale.
  double tolerance = 0.0;
  double start_time = 0.0;  ///< time of the start, s
};

/// Judges the frames of a run and keeps the worst verdict.
class Judge {
 public:
  static constexpr double kDriftThreshold = 0.01;
  static constexpr double kGainThreshold = 0.01;
  static constexpr double kDivergenceThreshold = 1.0;
  /// In units of `ReferenceRun::length`. Smaller errors are not visible in a picture of the chain.
  static constexpr double kInaccurateThreshold = 0.01;

  /// \throws InputError as EnergyBalance
  Judge(const Chain& chain, const State& start, const JudgeOptions& options);

  /// Judges the state at `time` s by its energy and its positions.
  /// \param dissipated `Integrator::dissipatedEnergy()`, J; used only if tracked
  /// \param reference  at the same time, measured; null: none
  /// \param supplied   `Integrator::suppliedEnergy()`, J
  const Verdict& judge(double time, const State& state, double dissipated,
                       const ReferenceRun* reference, double supplied = 0.0);

  /// Continues with another chain and from another state, see EnergyBalance::change.
  double change(const Chain& chain, const State& before, const State& after,
                const JudgeOptions& options, double supplied);

  const EnergyBalance& balance() const { return balance_; }
  /// The energy balance of the last judged state.
  const EnergyEntry& entry() const { return entry_; }
  const PositionError& positionError() const { return position_error_; }
  /// Whether the last judged frame may be shown: yes unless the motion has diverged; after a divergence
  /// only if the run continues and the energy is finite.
  bool isShown(bool continues_after_divergence) const;
  /// The first of the most severe verdicts so far: the verdict on the run.
  const Verdict& worst() const { return worst_; }

  /// What was measured: "largest position error 0.00024 m at t = 9.8 s, energy balance not checked".
  std::string measurements() const;
  /// A line if the position error of an error-controlled method exceeds ten tolerances or cannot be
  /// known to that; else empty.
  std::string toleranceRemark() const;

 private:
  void measure(const State& state, const ReferenceRun* reference);
  void noteTolerance(const ReferenceRun& reference);
  Verdict energyVerdict(double time, const State& state, double dissipated, double supplied);
  /// Whether the last judged state has the energy of the reference.
  bool hasEnergyOf(const ReferenceRun* reference) const;
  Verdict positionVerdict(const ReferenceRun* reference) const;
  const Verdict& remember(Verdict verdict);

  JudgeOptions options_;
  EnergyBalance balance_;
  double gain_sum_ = 0.0;      ///< sum of the relative gains of the judged frames
  double residual_sum_ = 0.0;  ///< sum of the relative residuals of the judged frames
  double frames_ = 0.0;
  double worst_residual_ = 0.0;  ///< largest relative residual of the energy balance
  // Since when the error has exceeded ten tolerances, s; 0: never.
  double exceeded_time_ = 0.0;   ///< where other methods keep the tolerance
  double sensitive_time_ = 0.0;  ///< where none can promise it
  EnergyEntry entry_;
  PositionError position_error_;
  Verdict latest_;
  Verdict worst_;
};

}  // namespace spring_pendulum
