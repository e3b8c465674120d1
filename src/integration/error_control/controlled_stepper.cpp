#include "integration/error_control/controlled_stepper.hpp"

#include "integration/error_control/heat_of_step.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spring_pendulum {

ControlledStepper::ControlledStepper(const Chain& chain, const IntegratorOptions& options,
                                     double allowed_error, int error_order,
                                     const ChainKernels& kernels)
    : chain_(chain),
      track_dissipation_(options.track_dissipation),
      allowed_error_(allowed_error),
      error_order_(error_order),
      constants_(chain_),
      kernels_(kernels),
      controller_(error_order),
      begin_(chain.size()),
      end_(chain.size()),
      begin_carry_(chain.size()),
      end_carry_(chain.size()),
      sample_(chain.size()) {}

void ControlledStepper::start(const State& state) {
  end_.values() = state.values();
  end_carry_.values().setZero();
  controller_.restart();
  restarted_ = true;
  // Short for any scene at this tolerance; the controller makes five times as much of it a step.
  next_step_ = std::max(0.01 * root(allowed_error_, error_order_), kShortestStep);
}

double ControlledStepper::step() {
  std::swap(begin_, end_);
  std::swap(begin_carry_, end_carry_);
  prepare(restarted_);
  restarted_ = false;
  for (;;) {
    const double h = admissible(std::clamp(next_step_, kShortestStep, kLongestStep));
    const double error = attempt(h) / allowed_error_;
    next_step_ = controller_.next(h, error);
    const bool at_the_shortest = h <= kShortestStep;
    if (StepController::accepts(error) || (at_the_shortest && std::isfinite(error))) {
      ++statistics_.accepted;
      statistics_.last_step = h;
      return h;
    }
    if (at_the_shortest) return 0.0;
    ++statistics_.rejected;
  }
}

void ControlledStepper::setEnd(const StateBuffer& change, SlopeSum sum) {
  kernels_.compensatedSum(begin_.pitch(), begin_.data(), change.data(), sum, end_.data(),
                          end_carry_.data());
}

double ControlledStepper::dissipated(double fraction) const {
  if (!track_dissipation_) return 0.0;
  return heatOfStep(*this, chain_, statistics_.last_step, fraction, sample_);
}

}  // namespace spring_pendulum
