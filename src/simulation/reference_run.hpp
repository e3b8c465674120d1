// A reference run: the same motion, integrated alongside a run with a much smaller error.
//
// A companion runs beside the reference. Its tolerance is a hundred times as large, and its start is
// moved by more than the rounding errors of a run amount to. Three times the distance between the two
// is taken as a bound on the error of the reference. The bound grows as small errors grow, whether
// they come from the steps or from rounding. Once the two have separated, the motion is too sensitive
// to be known, and the measurement ends.
//
// Everything is decided at frames and by counted work, which depend neither on the display rate nor on the machine.
#pragma once

#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

namespace spring_pendulum {

class ReferenceRun {
 public:
  /// Allocates the trajectories in the first `advance`.
  /// \param run_tolerance of the measured run, m; 0 for a fixed-step method. The tolerance of the
  ///   reference is a thousandth of this, at most 1e-10 m.
  /// \param always measure to the end, whatever the cost
  /// \throws InputError if the size of the start is not that of the chain
  ReferenceRun(const Chain& chain, const State& start, double run_tolerance = 0.0,
               bool always = false);

  /// Advances the reference to the next frame or, in several calls, through parts of it; see
  /// Integrator::advance. Does nothing once the measurement has stopped.
  /// \param stop asked every few milliseconds whether to give up; the measurement is over then
  /// \returns false if `stop` returned true
  /// \throws InputError as Integrator::advance
  bool advance(double time_step, std::int64_t steps, const std::function<bool()>& stop = {});

  /// Measures the uncertainty once per frame. Stops measuring if it or the cost is too large.
  /// \param run_work Integrator::work of the run so far, s. Until the next frame, the reference may
  ///   cost as much or 0.12 s, whichever is more.
  void measure(double run_work);

  double work() const;  ///< so far, s, see Integrator::work
  bool isMeasuring() const { return verdict_ == VerdictKind::kOk; }
  /// After the measurement has stopped: `kSensitive` if the true motion is not known, else `kNotChecked`.
  VerdictKind verdict() const { return verdict_; }
  std::string_view reason() const { return reason_; }  ///< why the measurement has stopped

  const State* state() const;  ///< at the time that `advance` has reached; null if it is not known

  /// Length to which position errors are related, m: `chainLength`, but at least a hundredth of the
  /// largest length of the reference at the measured frames (for particles that start close together).
  double length() const { return length_; }

  /// Bound on the position error of the reference at the last frame, m; NaN after it has stopped.
  double uncertainty() const { return uncertainty_; }

  /// Largest distance of a particle from its position in `state()`, m; NaN if that is not known.
  /// Errors below `uncertainty()` are not resolved.
  /// \throws InputError if the size of the state is not that of the chain
  double errorOf(const State& state) const;

  /// Whether the error of the companion at the last frame shows that perturbations of the motion have
  /// grown by more than about 100 times.
  bool isSensitive() const;

 private:
  void stop(std::string_view reason, VerdictKind verdict = VerdictKind::kNotChecked);

  struct Trajectory {
    std::unique_ptr<Integrator> integrator;
    State state;
  };

  Chain chain_;
  State start_;
  double length_;         ///< at the last frame, m
  double rounding_;       ///< smallest distance that can be resolved at the last frame, m
  double tolerance_;      ///< of the reference, m
  double free_work_;      ///< s
  double allowed_work_;   ///< until the next frame, s
  bool gave_up_ = false;  ///< inside a frame
  VerdictKind verdict_ = VerdictKind::kOk;
  std::string_view reason_;
  double distance_ = 0.0;                 ///< of the companion from the reference, m
  double uncertainty_;                    ///< m
  double work_at_stop_ = 0.0;             ///< s
  std::vector<Trajectory> trajectories_;  ///< reference and companion; empty: not running
};

}  // namespace spring_pendulum
