// A reference run: the same motion computed again, much more accurately, beside a run.
//
// Two error-controlled runs advance together with the run that is measured. The first one is the
// reference. The second one has a tolerance a hundred times as large, so the distance between the
// two bounds the error of the reference, also where small changes of the state grow: once the two
// have parted, the motion is too sensitive to be known, and the measurement ends.
//
// Beside an error-controlled run a third one starts from slightly longer springs. Its distance from
// the reference tells how much a small change grows, and so which tolerance can be kept. (Scaling
// the start keeps a straight chain straight: its motion would otherwise count as sensitive although
// no error ever leaves the line.)
//
// The cost is bounded by a count of work, not by a clock, so how long a run is
// measured does not depend on the machine. The run itself is never touched.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/export.hpp>
#include <spring_pendulum/model/state.hpp>

#include <cstdint>
#include <limits>
#include <vector>

namespace SPRING_PENDULUM_API spring_pendulum {

/// Length in m that position errors of a chain are compared with: the sum of its springs' rest
/// lengths, at least a tenth of its length at the start (for springs without rest length).
double chainLength(const Chain& chain, const State& start);

struct ReferenceOptions {
  /// Tolerance in m of the run that is measured, if it has one; infinite for a fixed step. The
  /// reference's tolerance is a thousandth of it, at most 1e-10 m.
  double run_tolerance = std::numeric_limits<double>::infinity();
  /// Measure to the end whatever it costs.
  bool always = false;
};

class ReferenceRun {
 public:
  enum class Status {
    kMeasuring,
    kCostTooMuch,  ///< stopped: the work allowed is used up
    kSensitive,    ///< stopped: the two runs parted, the true motion is no longer known
    kFailed        ///< stopped: a reference run diverged
  };

  /// An uncertainty above this share of the chain's length ends the measurement.
  static constexpr double kBelieved = 1e-3;

  /// Nothing is allocated before the first `advance`.
  ReferenceRun(const Chain& chain, const State& start, const ReferenceOptions& options = {});
  ~ReferenceRun();
  ReferenceRun(ReferenceRun&&) noexcept;
  ReferenceRun& operator=(ReferenceRun&&) noexcept;

  /// Follows the run on by `steps` steps of `time_step` s; see Integrator::advance for the times
  /// that this means. Does nothing once the measurement has stopped.
  /// \param run_work cost of the run so far, in force evaluations of Taylor-8; the reference may
  ///   cost as much, or some 0.2 s if that is more
  void advance(double time_step, std::int64_t steps, double run_work);

  /// Back to the start.
  void restart();

  Status status() const { return status_; }
  bool isMeasuring() const { return status_ == Status::kMeasuring; }

  /// True state, as well as it is known. The last one known once the measurement has stopped.
  const State& state() const { return state_; }

  /// Bound on the position error of `state()`, m; NaN once the measurement has stopped.
  double uncertainty() const { return uncertainty_; }

  /// Largest distance of a particle in `state` from where it should be, m; NaN once the
  /// measurement has stopped. An error below `uncertainty()` is not resolved.
  /// \throws InputError if `state` is not of the chain's size
  double errorOf(const State& state) const;

  /// How many times a small change of the start has grown, the most so far; NaN beside a run
  /// with a fixed step.
  double growth() const { return growth_; }

 private:
  struct Trajectory;

  void makeTrajectories();
  void compare();
  void stop(Status status);
  double allowedWork(double run_work) const;

  Chain chain_;
  State start_;
  bool always_;
  bool measures_growth_;
  double tolerance_;  ///< m
  double believed_;   ///< m
  double rounding_;   ///< m
  double growth_;
  Status status_ = Status::kMeasuring;
  State state_;
  double uncertainty_ = 0.0;
  std::vector<Trajectory> trajectories_;  ///< reference, second, and third where growth is wanted
};

}  // namespace spring_pendulum
