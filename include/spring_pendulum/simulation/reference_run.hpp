// A reference run: the same motion, integrated alongside a run with a much smaller error.
//
// Two error-controlled trajectories advance together with the measured run. The first is the
// reference. The tolerance of the second is a hundred times as large. Three times the distance
// between the two is taken as a bound on the error of the reference, also where small perturbations
// grow. When they have separated, the motion is too sensitive to be known, and the measurement ends.
//
// For an error-controlled run, two more trajectories start with slightly moved particles. Their
// distances from the reference measure the growth of perturbations, and thus which tolerance can be
// met. The first of them starts at the start of the run. The other starts again from the reference
// after 1, 2, 4, 8, ... output times, because a perturbation may decay before the motion becomes
// sensitive.
//
// The cost is bounded by a count of work, not by a clock, so how long a run is
// measured does not depend on the machine. The run itself is never touched.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>

#include <cstdint>
#include <limits>
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
    kFailed        ///< stopped: a reference run diverged
  };

  /// An uncertainty above this share of `chainLength` ends the measurement.
  static constexpr double kBelieved = 1e-3;

  /// Allocates the trajectories in the first `advance`.
  ReferenceRun(const Chain& chain, const State& start, const ReferenceOptions& options = {});
  ~ReferenceRun();
  ReferenceRun(ReferenceRun&&) noexcept;
  ReferenceRun& operator=(ReferenceRun&&) noexcept;

  /// Advances the reference by `steps` steps of `time_step` s, like Integrator::advance. Does
  /// nothing once the measurement has stopped.
  /// \param run_work cost of the run so far, s, see Integrator::work. The reference may cost as much
  ///   or about 0.1 s, whichever is more.
  void advance(double time_step, std::int64_t steps, double run_work);

  /// Measures how much small perturbations have grown, see `growth()`. Call it once per frame; then
  /// the result does not depend on how often `advance` is called between the frames.
  void measureGrowth();

  /// Returns to the start.
  void restart();

  Status status() const { return status_; }
  bool isMeasuring() const { return status_ == Status::kMeasuring; }

  /// State of the reference; the last one if the measurement has stopped.
  const State& state() const { return state_; }

  /// Bound on the position error of `state()`, m; NaN after the measurement has stopped.
  double uncertainty() const { return uncertainty_; }

  /// Largest distance of a particle from its reference position, m; NaN after the measurement has
  /// stopped. Errors below `uncertainty()` are not resolved.
  /// \throws InputError if the size of the state is not that of the chain
  double errorOf(const State& state) const;

  /// Largest measured growth factor of a small perturbation, of the start or of a later state; a
  /// lower bound, as few perturbations are tried. NaN for a fixed-step method.
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
  std::int64_t measurements_ = 0;  ///< of the growth
  Status status_ = Status::kMeasuring;
  State state_;
  double uncertainty_ = 0.0;
  /// Reference, second, and for the growth two perturbed ones.
  std::vector<Trajectory> trajectories_;
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
