// A reference run: the same motion, integrated alongside a run with a much smaller error.
//
// A companion runs beside the reference. Its tolerance is a hundred times as large, and its start is
// moved by more than the rounding errors of a run amount to. Three times the distance between the two
// is taken as a bound on the error of the reference. The bound grows as small errors grow, whether
// they come from the steps or from rounding. Once the two have separated, the motion is too sensitive
// to be known, and the measurement ends.
//
// Everything is decided at frames and by counted work, so how long a run is measured depends neither
// on the display rate nor on the machine. The run itself is never touched.
#pragma once

#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace spring_pendulum {

/// What the errors of a reference run are measured in, m.
struct ReferenceScales {
  double length;     ///< to which position errors are related
  double rounding;   ///< smallest distance that can be resolved
  double tolerance;  ///< of the reference
};

struct ReferenceOptions {
  /// Tolerance in m of the measured run; 0 for a fixed-step method. The tolerance of the reference is
  /// a thousandth of this, at most 1e-10 m.
  double tolerance = 0.0;
  /// Measure to the end, whatever the cost.
  bool always = false;
};

class ReferenceRun {
 public:
  enum class Status {
    kMeasuring,
    kCostTooMuch,  ///< stopped: the allowed work is used up
    kSensitive,    ///< stopped: the trajectories separated, the true motion is not known
    kRounded,      ///< stopped: the positions are too large to be resolved
    kFailed,       ///< stopped: a trajectory diverged
    kChanged       ///< stopped: the measured run was changed
  };

  /// An uncertainty above this share of `length()` ends the measurement.
  static constexpr double kBelieved = 1e-3;

  /// Allocates the trajectories in the first `advance`.
  /// \throws InputError if the size of the start is not that of the chain
  ReferenceRun(const Chain& chain, const State& start, const ReferenceOptions& options = {});

  /// Advances the reference to the next frame or, in several calls, through parts of it; see
  /// Integrator::advance. Does nothing once the measurement has stopped.
  /// \param stop asked every few milliseconds whether to give up; the measurement is over then
  /// \returns false if `stop` returned true
  /// \throws InputError as Integrator::advance
  bool advance(double time_step, std::int64_t steps, const std::function<bool()>& stop = {});

  /// Measures the uncertainty, and stops measuring if it or the cost is too large. Call it once per
  /// frame.
  /// \param run_work Integrator::work of the run so far, s. Until the next frame, the reference may
  ///   cost as much or 0.12 s, whichever is more.
  void measure(double run_work);

  /// Work so far, s, see Integrator::work.
  double work() const;

  /// Stops measuring, because the measured run is no longer that of the same chain.
  void stopAtChange() { stop(Status::kChanged); }

  Status status() const { return status_; }
  bool isMeasuring() const { return status_ == Status::kMeasuring; }

  /// State of the reference at the time that `advance` has reached; null if it is not known.
  const State* state() const;

  /// Length to which position errors are related, m: `chainLength`, but at least a hundredth of the
  /// largest length of the reference at the measured frames (for particles that start close together).
  double length() const { return scales_.length; }

  /// Bound on the position error of the reference at the last frame, m; NaN after the measurement has
  /// stopped.
  double uncertainty() const { return uncertainty_; }

  /// Largest distance of a particle from its position in `state()`, m; NaN if that is not known.
  /// Errors below `uncertainty()` are not resolved.
  /// \throws InputError if the size of the state is not that of the chain
  double errorOf(const State& state) const;

  /// Whether the error of the companion at the last frame shows that perturbations of the motion have
  /// grown by more than about 100 times.
  bool isSensitive() const;

 private:
  struct Trajectory {
    std::unique_ptr<Integrator> integrator;
    State state;
  };

  void stop(Status status);

  Chain chain_;
  State start_;
  ReferenceScales scales_;  ///< at the last frame
  double free_work_;        ///< s
  double allowed_work_;     ///< until the next frame, s
  bool gave_up_ = false;    ///< inside a frame
  Status status_ = Status::kMeasuring;
  double distance_ = 0.0;      ///< of the companion from the reference, m
  double uncertainty_;         ///< m
  double work_at_stop_ = 0.0;  ///< s
  std::vector<Trajectory>
      trajectories_;  ///< reference and companion; empty: not started or stopped
};

}  // namespace spring_pendulum
