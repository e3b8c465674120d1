// Trial runs.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/frame_steps.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <cstdint>
#include <optional>

namespace spring_pendulum {

/// The result of a trial run.
struct Trial {
  bool affordable = true;  ///< whether the trial ended within the allowed work
  Verdict verdict;
  double energy_error = 0.0;  ///< largest relative residual of the energy balance
  PositionError position_error;
  bool measured = false;  ///< whether the reference run covers the whole trial
  bool reference_too_costly = false;
  std::int64_t evaluations = 0;  ///< force evaluations, without those of the reference run
  double work = 0.0;             ///< their cost, s, see Integrator::work
};

/// Makes trial runs of a chain from a start, with any method and step size. Refers to the chain and
/// the start, which must outlive the bench.
class TrialBench {
 public:
  /// Allowed work of a trial without its reference run, s, see Integrator::work.
  static constexpr double kMostWork = 0.06;

  /// \param duration       duration of the run, s
  /// \param frame_interval approximate time between judged states, s
  TrialBench(const Chain& chain, const State& start, double duration, double frame_interval,
             double most_work = kMostWork)
      : chain_(chain),
        start_(start),
        duration_(duration),
        frame_interval_(frame_interval),
        most_work_(most_work) {}

  /// Runs frame by frame to the end, or until the verdict is `enough` or worse.
  /// \param tolerance m; nothing for a fixed-step method
  Trial run(const Method& method, std::optional<double> tolerance, const FrameSteps& frame,
            std::int64_t frames, bool with_reference,
            VerdictKind enough = VerdictKind::kDiverged) const;

  /// Runs with frames of about `frame_interval`.
  /// \param step step size in s; for an error-controlled method the tolerance in m
  Trial run(const Method& method, double step, bool with_reference,
            VerdictKind enough = VerdictKind::kDiverged) const;

  /// Number of frames of a fixed-step method that an affordable trial can have.
  std::int64_t affordableFrames(const Method& method, const FrameSteps& frame) const;

  /// Smallest step size of an affordable trial, s.
  double leastStep(const Method& method) const;

  /// Work of a run with a fixed step, s.
  double workOf(const Method& method, double step) const;

  double duration() const { return duration_; }

 private:
  const Chain& chain_;
  const State& start_;
  double duration_;
  double frame_interval_;
  double most_work_;
};

}  // namespace spring_pendulum
