#include "integration/error_control/error_controlled.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace spring_pendulum {
namespace {

/// In distances of output: steps shorter than that would never get there.
constexpr double kLeastStep = 1e-12;

}  // namespace

ErrorControlled::ErrorControlled(std::unique_ptr<AdaptiveStepper> stepper)
    : stepper_(std::move(stepper)) {}

void ErrorControlled::restart() {
  started_ = false;
  heat_before_step_ = 0.0;
  heat_in_step_ = 0.0;
}

void ErrorControlled::takeStep() {
  if (step_length_ > 0.0) heat_before_step_ += stepper_->dissipated(1.0);
  step_length_ = stepper_->step();
  diverged_ = !(step_length_ > kLeastStep * output_step_);
  step_begin_ = step_end_;
  step_end_ = step_begin_ + step_length_;
}

void ErrorControlled::advance(State& state, double time_step, std::int64_t steps) {
  advanceWithin(state, time_step, steps, std::numeric_limits<std::int64_t>::max());
}

bool ErrorControlled::advanceWithin(State& state, double time_step, std::int64_t steps,
                                    std::int64_t most_evaluations) {
  if (!started_) {
    stepper_->start(state);
    started_ = true;
    diverged_ = false;
    output_origin_ = 0.0;
    outputs_ = 0;
    step_begin_ = step_length_ = step_end_ = 0.0;
  } else if (time_step != output_step_) {
    output_origin_ += static_cast<double>(outputs_) * output_step_;
    outputs_ = 0;
  }
  output_step_ = time_step;
  if (steps == 0) return true;
  outputs_ += steps;
  const double output_time = output_origin_ + static_cast<double>(outputs_) * time_step;
  while (!diverged_ && step_end_ < output_time) {
    if (forceEvaluations() >= most_evaluations) return false;
    takeStep();
  }
  if (diverged_) {
    state.values()
        .bottomRows(state.size() - 1)
        .setConstant(std::numeric_limits<double>::quiet_NaN());
    return true;
  }
  const double fraction = std::min((output_time - step_begin_) / step_length_, 1.0);
  stepper_->interpolate(fraction, state);
  heat_in_step_ = stepper_->dissipated(fraction);
  return true;
}

}  // namespace spring_pendulum
