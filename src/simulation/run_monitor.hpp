// Watches a run, for Exercise3 and the node alike: energy balance, reference run and verdict.
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

/// Whether a run computes its energy balance unasked: where that is expected to cost at most 50 ms
/// or 10 %.
bool energyBalanceIsCheap(const Scenario& scenario, const Chain& chain);

class RunMonitor {
 public:
  /// \param wants_energy the energy balance is computed whatever it costs
  /// \throws InputError as Judge, std::runtime_error as checkMemory
  RunMonitor(const Scenario& scenario, const Chain& chain, const State& start, bool wants_energy);

  /// What the integrator of the run must be told. Without damping there is nothing to track.
  bool tracksDissipation() const { return tracks_dissipation_; }

  /// Moves the reference on with the run.
  void follow(double time_step, std::int64_t steps);

  /// Judges a frame at `time` s.
  const Verdict& judge(double time, const State& state, const Integrator& integrator);

  /// Back to frame 0.
  void restart();

  /// Whether the frame judged last may be shown and written: not if the motion diverged, unless
  /// `on_divergence` says so and its energy is finite.
  bool isShown() const;

  /// The verdict on the run so far.
  const Verdict& verdict() const { return judge_.worst(); }
  /// The energy balance of the frame judged last.
  const EnergyEntry& energyEntry() const { return judge_.entry(); }
  /// The energy balance of a state between the frames.
  EnergyEntry energyEntry(double time, const State& state, const Integrator& integrator) const;
  /// Position errors at the frames judged so far.
  const PositionError& positionError() const { return judge_.positionError(); }
  /// Position error of a state between the frames, m; NaN where it is not measured.
  double positionErrorOf(const State& state) const;
  /// Null if no reference runs, or none runs any more.
  const ReferenceRun* reference() const;

  /// "largest position error 0.0039 m at t = 49.3 s, largest energy error 1.2e-07 of the energy scale"
  std::string measurements() const;
  /// A tolerance that was not kept, and why; empty if it was, or there is none.
  std::string toleranceRemark() const;
  /// Wall-clock time that the reference took, s.
  double seconds() const { return seconds_; }

 private:
  void noteTolerance();

  Scenario scenario_;
  bool tracks_dissipation_;
  double tolerance_;  ///< m; infinite for a fixed-step method
  Judge judge_;
  std::optional<ReferenceRun> reference_;
  double work_per_evaluation_;
  double run_work_ = 0.0;        ///< until the frame judged last
  double worst_residual_ = 0.0;  ///< of the energy balance, relative
  double exceeded_time_ = 0.0;   ///< s, when the error exceeded ten tolerances; 0: it did not
  double exceeded_growth_ = 0.0;
  double seconds_ = 0.0;
};

}  // namespace spring_pendulum
