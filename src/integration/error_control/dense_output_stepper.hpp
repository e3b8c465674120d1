// The interface of error-controlled methods: one accepted step of a length that the method chooses,
// and the motion inside that step. Output times, restarts and the dissipated energy are left to
// `DenseOutputIntegrator`, which owns a stepper. `Auto` is a stepper that owns several.
#pragma once

#include <spring_pendulum/model/state.hpp>

#include <cstdint>
#include <string>

namespace spring_pendulum {

/// What a stepper has done since it was made.
struct StepStatistics {
  std::int64_t force_evaluations = 0;  ///< of F for the whole chain
  /// What the evaluations of dearer methods cost beyond those of Taylor-8, in those of Taylor-8.
  double extra_work = 0.0;
  std::int64_t accepted = 0;  ///< steps
  std::int64_t rejected = 0;  ///< steps whose error was too large
  double last_step = 0.0;     ///< length of the last accepted step, s
  /// Largest |λ| of the motion seen in the last step, 1/s, where the method notices it for free;
  /// else 0. A method whose last_step * fastest_rate is near its stability limit is held back by
  /// stability, not by accuracy.
  double fastest_rate = 0.0;

  double work() const { return static_cast<double>(force_evaluations) + extra_work; }
};

/// No stepper takes a shorter step: at this length it goes on whatever the estimated error, so a
/// particle that runs through its neighbour (where the force jumps) does not stop the clock.
inline constexpr double kShortestStep = 1e-12;  // s
/// No stepper takes a longer one, not even for a chain at rest.
inline constexpr double kLongestStep = 1.0;  // s

/// An error-controlled method for one chain. The workspace is allocated when the stepper is made or
/// first started, never while stepping. Nothing depends on output times.
class DenseOutputStepper {
 public:
  virtual ~DenseOutputStepper() = default;
  DenseOutputStepper(const DenseOutputStepper&) = delete;
  DenseOutputStepper& operator=(const DenseOutputStepper&) = delete;

  /// Begins anew at `state`, with the first particle at rest. Only the statistics go on.
  /// \throws InputError if the state is not of the chain's size
  virtual void start(const State& state) = 0;

  /// Takes one step that meets the tolerance, repeating it as needed.
  /// \returns its length in s, in (0, kLongestStep]; 0 if the motion diverged (a number that is not
  ///          finite came up), after which only `start` may be called
  virtual double step() = 0;

  /// The state inside the last step.
  /// \param fraction 0 at its beginning, 1 at its end
  /// \param[out] state of the size of the chain
  virtual void interpolate(double fraction, State& state) const = 0;

  virtual StepStatistics statistics() const = 0;

  /// See Integrator::report.
  virtual std::string report() const { return {}; }

 protected:
  DenseOutputStepper() = default;
};

}  // namespace spring_pendulum
