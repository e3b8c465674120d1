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
#include <limits>
#include <memory>
#include <vector>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Length in m to which position errors are related: the sum of the rest lengths, but at least a
/// tenth of the length of the chain at the start (for springs with rest length 0).
double chainLength(const Chain& chain, const State& start);

struct ReferenceOptions {
  /// Tolerance in m of the measured run; infinite for a fixed-step method. The tolerance of the
  /// reference is a thousandth of this, at most 1e-10 m.
  double run_tolerance = std::numeric_limits<double>::infinity();
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
    kFailed        ///< stopped: a trajectory diverged
  };

  /// An uncertainty above this share of `chainLength` ends the measurement.
  static constexpr double kBelieved = 1e-3;

  /// Allocates the trajectories in the first `advance`.
  ReferenceRun(const Chain& chain, const State& start, const ReferenceOptions& options = {});

  /// Advances the reference to the next frame or, in several calls, through parts of it; see
  /// Integrator::advance. Does nothing once the measurement has stopped.
  /// \param stop asked every few milliseconds whether to give up; only `restart` may follow then
  /// \returns false if `stop` returned true
  /// \throws InputError as Integrator::advance
  bool advance(double time_step, std::int64_t steps, const std::function<bool()>& stop = {});

  /// Measures the uncertainty, and stops measuring if it or the cost is too large. Call it once per
  /// frame.
  /// \param run_work Integrator::work of the run so far, s. Until the next frame, the reference may
  ///   cost as much or 0.12 s, whichever is more.
  void measure(double run_work);

  /// Returns to the start.
  void restart();

  Status status() const { return status_; }
  bool isMeasuring() const { return status_ == Status::kMeasuring; }

  /// State of the reference at the time that `advance` has reached; null if it is not known.
  const State* state() const;

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

  double work() const;
  void stop(Status status);

  Chain chain_;
  State start_;
  double believed_;             ///< m
  double rounding_;             ///< m
  double tolerance_;            ///< m
  double companion_tolerance_;  ///< m
  double free_work_;            ///< s
  double allowed_work_ = 0.0;   ///< until the next frame, s
  bool gave_up_ = false;        ///< inside a frame
  Status status_ = Status::kMeasuring;
  double distance_ = 0.0;                 ///< of the companion from the reference, m
  double uncertainty_ = 0.0;              ///< m
  std::vector<Trajectory> trajectories_;  ///< reference and companion
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
