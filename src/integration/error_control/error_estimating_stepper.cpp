#include "integration/error_control/error_estimating_stepper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

/// Factor of the first step size; the controller can then increase it fivefold per step.
constexpr double kFirstStep = 0.01;

}  // namespace

ErrorEstimatingStepper::ErrorEstimatingStepper(const Chain& chain, double allowed_error,
                                               int error_order, const ChainKernels& kernels,
                                               double first_step)
    : chain_(chain),
      constants_(chain_),
      kernels_(kernels),
      begin_(chain.size()),
      end_(chain.size()),
      carry_(chain.size()),
      allowed_error_(allowed_error),
      first_step_(first_step > 0.0 ? first_step : kFirstStep * root(allowed_error, error_order)),
      controller_(error_order),
      end_carry_(chain.size()) {}

void ErrorEstimatingStepper::start(const State& state) {
  for (StateBuffer* buffer : {&end_, &end_carry_}) buffer->setZero();
  end_.values() = state.values();
  controller_.restart();
  restarted_ = true;
  next_step_ = std::max(first_step_, kShortestStep);
}

double ErrorEstimatingStepper::step() {
  std::swap(begin_, end_);
  std::swap(carry_, end_carry_);
  prepare(restarted_);
  restarted_ = false;
  for (;;) {
    const double h = admissible(std::clamp(next_step_, kShortestStep, kLongestStep));
    const double error = attempt(h) / allowed_error_;
    next_step_ = controller_.next(h, error);
    const bool is_shortest = h <= kShortestStep;
    if (StepSizeController::accepts(error) || (is_shortest && end_.values().allFinite())) {
      ++statistics_.accepted;
      statistics_.last_step = h;
      return h;
    }
    if (is_shortest) return 0.0;
  }
}

void ErrorEstimatingStepper::setEnd(const StateBuffer& change, const SlopeSum& sum) {
  kernels_.compensatedSum(begin_.pitch(), begin_.data(), change.data(), sum, end_.data(),
                          end_carry_.data());
}

}  // namespace spring_pendulum
