// The interface of error-controlled methods: one accepted step, whose size the method chooses, and
// the motion inside this step. `DenseOutputIntegrator` owns a stepper and handles output times,
// restarts and the dissipated energy. `AutoStepper` is a stepper that owns several steppers.
#pragma once

#include "integration/kernels/kernel_data.hpp"
#include <spring_pendulum/model/state.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace spring_pendulum {

/// Work of a stepper since its construction.
struct StepStatistics {
  std::int64_t force_evaluations = 0;  ///< evaluations of F for the whole chain
  std::int64_t accepted = 0;           ///< accepted steps
  double last_step = 0.0;              ///< size of the last accepted step, s
};

/// Smallest step size. A step of this size is accepted whatever its estimated error, so that the
/// integration gets past a collision of two neighbours, where the force is discontinuous.
inline constexpr double kShortestStep = 1e-12;  // s
/// Largest step size, also for a chain at rest.
inline constexpr double kLongestStep = 1.0;  // s

/// An error-controlled method for one chain. Allocates its workspace when constructed or first
/// started, not while stepping (see `Integrator` for the exception). Steps do not depend on output
/// times.
class DenseOutputStepper {
 public:
  virtual ~DenseOutputStepper() = default;
  DenseOutputStepper(const DenseOutputStepper&) = delete;
  DenseOutputStepper& operator=(const DenseOutputStepper&) = delete;

  /// Starts at `state`, of the size of the chain, with the first particle at rest. Keeps only the
  /// statistics.
  virtual void start(const State& state) = 0;

  /// Takes one step that meets the tolerance, repeating it as needed.
  /// \returns its size in s, in (0, kLongestStep]; 0 if the motion diverged (a number is not
  ///          finite), after which only `start` may be called
  virtual double step() = 0;

  /// Returns the state inside the last step, valid until the next call of a function of the stepper.
  /// \param fraction 0 at its beginning, 1 at its end
  virtual const StateBuffer& stateAt(double fraction) const = 0;

  /// Tension of a spring inside the last step, N, if the method solves for it. Computed from velocities, that of
  /// a strongly damped spring would consist of their errors.
  virtual std::optional<double> tensionAt(Eigen::Index /*spring*/, double /*fraction*/) const {
    return std::nullopt;
  }

  virtual StepStatistics statistics() const = 0;

  /// Mean cost of an evaluation, in force evaluations of Taylor-8.
  virtual double workPerEvaluation() const { return 1.0; }

  /// See Integrator::report.
  virtual std::string report() const { return {}; }

 protected:
  DenseOutputStepper() = default;
};

}  // namespace spring_pendulum
