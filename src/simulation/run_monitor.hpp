// Monitors a run, for Exercise3 and the node: energy balance, reference run and verdict.
#pragma once

#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/simulation/reference_run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace spring_pendulum {

/// Whether a run computes its energy balance by default: if the expected cost is at most 50 ms or
/// 10 % of the run.
bool energyBalanceIsCheap(const Scenario& scenario, const Chain& chain);

/// Runs the reference and judges every frame of a run.
class RunMonitor {
 public:
  /// \param wants_energy compute the energy balance, whatever the cost
  /// \throws InputError as Judge, std::runtime_error as checkMemory
  RunMonitor(const Scenario& scenario, const Chain& chain, const State& start, bool wants_energy);

  /// Value of `track_dissipation` for the integrator of the run; false without damping.
  bool tracksDissipation() const { return tracks_dissipation_; }

  /// Advances the reference run.
  void follow(double time_step, std::int64_t steps);

  /// Judges a frame at `time` s.
  const Verdict& judge(double time, const State& state, const Integrator& integrator);

  /// Returns to frame 0.
  void restart();

  /// Whether the last judged frame may be shown and written: yes unless the motion diverged; after
  /// a divergence only if `on_divergence` is `kContinue` and the energy is finite.
  bool isShown() const;

  /// The verdict on the run so far.
  const Verdict& verdict() const { return judge_.worst(); }
  /// The energy balance of the last judged frame.
  const EnergyEntry& energyEntry() const { return judge_.entry(); }
  /// The energy balance of a state between the frames.
  EnergyEntry energyEntry(double time, const State& state, const Integrator& integrator) const;
  /// Position errors at the frames so far.
  const PositionError& positionError() const { return judge_.positionError(); }
  /// Position error of a state between the frames, m; NaN if not measured.
  double positionErrorOf(const State& state) const;
  /// The reference run; null if there is none or it has stopped.
  const ReferenceRun* reference() const;

  /// Returns a text such as "largest position error 0.0039 m at t = 49.3 s, largest energy error
  /// 1.2e-07 times the energy scale".
  std::string measurements() const;
  /// A sentence on a tolerance that was not met, and the reason; else empty.
  std::string toleranceRemark() const;
  /// Wall-clock time of the reference run, s.
  double seconds() const { return seconds_; }

 private:
  void noteTolerance();

  Scenario scenario_;
  bool tracks_dissipation_;
  double tolerance_;  ///< m; infinite for a fixed-step method
  Judge judge_;
  std::optional<ReferenceRun> reference_;
  double work_per_evaluation_;
  std::optional<std::int64_t> evaluations_before_;  ///< force evaluations before frame 0
  double run_work_ = 0.0;                           ///< work until the last judged frame
  double worst_residual_ = 0.0;   ///< largest relative residual of the energy balance
  double exceeded_time_ = 0.0;    ///< s, when the error first exceeded ten tolerances; 0: never
  double exceeded_growth_ = 0.0;  ///< growth of perturbations until then
  double seconds_ = 0.0;
};

}  // namespace spring_pendulum
