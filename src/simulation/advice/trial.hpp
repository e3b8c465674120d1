// Trial runs of a scene.
#pragma once

#include <spring_pendulum/simulation/run.hpp>

#include <cstdint>
#include <functional>
#include <string>

namespace spring_pendulum {

/// The outcome of a trial run.
struct Trial {
  bool finished = false;  ///< false: the allowed work was used up, or the trial was stopped
  Verdict verdict;
  PositionError position_error;
  bool measured = false;  ///< whether the reference run covers the whole trial
  std::string measurements;
  std::int64_t evaluations = 0;  ///< of F, without those of the reference run
  double work = 0.0;             ///< of the method and the frames, s, see Integrator::work

  bool isStable() const { return finished && verdict.kind < VerdictKind::kGainedEnergy; }
};

/// What all trials of a scene have in common.
class TrialBench {
 public:
  /// Work in s that `--check` allows for a trial, without its reference run.
  static constexpr double kMostWork = 0.06;

  /// Work of all trials with their reference runs, in units of that of one. After this much, no
  /// further trial starts.
  static constexpr double kMostTotalWork = 100.0;

  /// \param stop ends all trials when it returns true; may be empty
  TrialBench(const Chain& chain, const State& start, double duration, double frame_interval,
             std::function<bool()> stop = {}, double most_work = kMostWork);

  /// Runs a scenario with the springs of the chain to the end, or until the verdict is `enough` or
  /// worse.
  Trial run(Scenario scenario, ReferenceUse reference,
            VerdictKind enough = VerdictKind::kDiverged) const;

  /// Runs for `duration` s with frames of about `frame_interval` s, at most 2,000.
  /// \param setting step size in s; for an error-controlled method the tolerance in m
  Trial run(const Method& method, double setting, ReferenceUse reference,
            VerdictKind enough = VerdictKind::kDiverged) const;

  /// Smallest step size of a fixed-step method that the allowed work permits, s.
  double leastStep(const Method& method) const;

  /// Smallest tolerance that the positions permit, m.
  double leastTolerance() const { return least_tolerance_; }

  double duration() const { return duration_; }
  double mostWork() const { return most_work_; }
  /// Whether the work of all trials is used up: a trial is then unfinished from the beginning.
  bool isExhausted() const { return total_work_ >= allowed_work_; }
  void limitWork(double most_work) { most_work_ = most_work; }

 private:
  Particles particles_;
  SpringLaw spring_;
  double gravity_;
  double air_drag_;
  double least_tolerance_;
  double duration_;
  double frame_interval_;
  std::function<bool()> stop_;
  double most_work_;
  double allowed_work_;              ///< of all trials, s
  mutable double total_work_ = 0.0;  ///< s, so far
};

}  // namespace spring_pendulum
