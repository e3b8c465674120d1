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
#include "integration/kernels/kernel_data.hpp"
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
  /// \param allowed_error largest estimated error of a step, in the unit of `attempt`
  /// \param error_order the estimated error is O(h^error_order)
  /// \param first_step s; 0: one that is short for any scene
  ErrorEstimatingStepper(const Chain& chain, double allowed_error, int error_order,
                         const ChainKernels& kernels, double first_step = 0.0);

  /// Called before the first attempt from a new `begin_`.
  /// \param restarted whether `begin_` is an initial state and not the end of the last step
  virtual void prepare(bool restarted) = 0;

  /// Computes `end_` from `begin_` with step size h.
  /// \returns the estimated position error, m; NaN if anything is not finite
  virtual double attempt(double h) = 0;

  /// Returns the state inside the last step, see stateAt; `fraction` is below 1.
  virtual const StateBuffer& stateInside(double fraction) const = 0;

  /// Largest admissible step size, at most h, s.
  virtual double admissible(double h) { return h; }

  /// end_ = begin_ + (change + sum), where change contains `carry_`.
  void setEnd(const StateBuffer& change, const SlopeSum& sum);

  const Chain chain_;
  const KernelConstants constants_;
  const ChainKernels& kernels_;
  StateBuffer begin_, end_;
  StateBuffer carry_;  ///< rounding error of `begin_`: add it to the next step
  StepStatistics statistics_;

 private:
  const double allowed_error_;
  const double first_step_;  ///< s
  StepSizeController controller_;
  StateBuffer end_carry_;
  bool restarted_ = true;
  double next_step_ = 0.0;
};

}  // namespace spring_pendulum
