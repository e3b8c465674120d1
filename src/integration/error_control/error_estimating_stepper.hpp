// Base class of one-step methods that estimate their local error. It repeats a step until its error
// is small enough, then chooses the size of the next step.
//
// States are updated with compensated summation: the rounding error of each step is added to the
// next step. Without this, rounding errors would dominate at the tightest tolerances.
//
// Reference: N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., SIAM 2002,
// section 4.3 (compensated summation).
#pragma once

#include "integration/error_control/dense_output_stepper.hpp"
#include "integration/error_control/step_size_controller.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/kernel_constants.hpp"
#include "integration/kernels/state_buffer.hpp"
#include <spring_pendulum/model/chain.hpp>

namespace spring_pendulum {

class ErrorEstimatingStepper : public DenseOutputStepper {
 public:
  void start(const State& state) final;
  double step() final;
  const StateBuffer& stateAt(double fraction) const final {
    return fraction < 1.0 ? stateInside(fraction) : end_;
  }
  StepStatistics statistics() const override { return statistics_; }

 protected:
  struct ErrorControl {
    double allowed;     ///< largest estimated error of a step, in the unit of `attempt`
    int order;          ///< the estimated error is O(h^order)
    double first_step;  ///< s
  };
  ErrorEstimatingStepper(const Chain& chain, const ErrorControl& control,
                         const ChainKernels& kernels);
  /// Uses a first step that is short for any scene.
  ErrorEstimatingStepper(const Chain& chain, double allowed_error, int error_order,
                         const ChainKernels& kernels);

  /// Called before the first attempt from a new `begin()`.
  /// \param restarted whether `begin()` is an initial state and not the end of the last step
  virtual void prepare(bool restarted) = 0;

  /// Computes `end()` from `begin()` with step size h.
  /// \returns the estimated position error, m; NaN if anything is not finite
  virtual double attempt(double h) = 0;

  /// Returns the state inside the last step, see stateAt; `fraction` is below 1.
  virtual const StateBuffer& stateInside(double fraction) const = 0;

  /// Largest admissible step size, at most h, s.
  virtual double admissible(double h) { return h; }

  const Chain& chain() const { return chain_; }
  const KernelChain& kernelChain() const { return constants_.chain(); }
  const ChainKernels& kernels() const { return kernels_; }
  StateBuffer& begin() { return begin_; }
  StateBuffer& end() { return end_; }
  const StateBuffer& begin() const { return begin_; }
  const StateBuffer& end() const { return end_; }
  /// Rounding error of `begin()`: add it to the next step.
  const StateBuffer& carry() const { return begin_carry_; }
  /// end() = begin() + (change + sum), where change contains `carry()`.
  void setEnd(const StateBuffer& change, SlopeSum sum);
  /// The dense output may need evaluations, too.
  StepStatistics& counters() const { return statistics_; }

 private:
  Chain chain_;
  ErrorControl control_;
  KernelConstants constants_;
  const ChainKernels& kernels_;
  StepSizeController controller_;
  StateBuffer begin_;
  StateBuffer end_;
  StateBuffer begin_carry_;
  StateBuffer end_carry_;
  bool restarted_ = true;
  double next_step_ = 0.0;
  mutable StepStatistics statistics_;
};

}  // namespace spring_pendulum
