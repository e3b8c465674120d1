#include "integration/error_control/error_estimating_stepper.hpp"

#include "model/checks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spring_pendulum {

ErrorEstimatingStepper::ErrorEstimatingStepper(const Chain& chain, double allowed_error,
                                               int error_order, const ChainKernels& kernels)
    : chain_(chain),
      allowed_error_(allowed_error),
      error_order_(error_order),
      constants_(chain_),
      kernels_(kernels),
      controller_(error_order),
      begin_(chain.size()),
      end_(chain.size()),
      begin_carry_(chain.size()),
      end_carry_(chain.size()) {}

void ErrorEstimatingStepper::start(const State& state) {
  requireSize(chain_.size(), state);
  end_.values() = state.values();
  end_.values().row(0).rightCols<2>().setZero();
  end_carry_.values().setZero();
  controller_.restart();
  restarted_ = true;
  // Short for any scene at this tolerance; the controller makes five times as much of it a step.
  next_step_ = std::max(0.01 * root(allowed_error_, error_order_), kShortestStep);
}

double ErrorEstimatingStepper::step() {
  std::swap(begin_, end_);
  std::swap(begin_carry_, end_carry_);
  prepare(restarted_);
  restarted_ = false;
  for (;;) {
    const double h = admissible(std::clamp(next_step_, kShortestStep, kLongestStep));
    const double error = attempt(h) / allowed_error_;
    next_step_ = controller_.next(h, error);
    const bool at_the_shortest = h <= kShortestStep;
    if (StepSizeController::accepts(error) || (at_the_shortest && std::isfinite(error))) {
      ++statistics_.accepted;
      statistics_.last_step = h;
      return h;
    }
    if (at_the_shortest) return 0.0;
    ++statistics_.rejected;
  }
}

void ErrorEstimatingStepper::setEnd(const StateBuffer& change, SlopeSum sum) {
  kernels_.compensatedSum(begin_.pitch(), begin_.data(), change.data(), sum, end_.data(),
                          end_carry_.data());
}

}  // namespace spring_pendulum
