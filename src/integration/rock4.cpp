#include <spring_pendulum/integration/rock4.hpp>
#include <spring_pendulum/model/chain_modes.hpp>

#include <algorithm>
#include <utility>

namespace spring_pendulum {
namespace {

/// The last percents of a stability interval are left to the springs' own part of the rates.
constexpr double kUsedStability = 0.97;

double longestStep(const Rock4Coefficients& method, double rate) {
  return kUsedStability * method.real_stability_limit / rate;
}

}  // namespace

Rock4Stepper::Rock4Stepper(const Chain& chain, const IntegratorOptions& options,
                           double share_of_tolerance)
    : ControlledStepper(chain, options, share_of_tolerance * options.tolerance, 4),
      fastest_rate_(chain.spring().damping * largestSpringMode(chain)),
      method_(&rock4Table().front()),
      first_slope_(chain.size()),
      inner_{StateBuffer(chain.size()), StateBuffer(chain.size())} {
  for (StateBuffer& slope : slopes_) slope = StateBuffer(chain.size());
}

void Rock4Stepper::prepare(bool restarted) {
  if (restarted) {
    computeSlope(begin(), {}, first_slope_);
  } else {
    std::swap(first_slope_, slopes_.back());
  }
}

double Rock4Stepper::admissible(double h) {
  const auto& table = rock4Table();
  method_ = table.data();
  if (fastest_rate_ == 0.0) return h;
  h = std::min(h, longestStep(table.back(), fastest_rate_));
  while (longestStep(*method_, fastest_rate_) < h) ++method_;
  if (method_ == table.data()) return h;
  // The longest step of fewer stages may go further per stage.
  const Rock4Coefficients& fewer = *(method_ - 1);
  const double shorter = longestStep(fewer, fastest_rate_);
  if (shorter * method_->stages < h * fewer.stages) return h;
  method_ = &fewer;
  return shorter;
}

void Rock4Stepper::computeSlope(const StateBuffer& state, SlopeSum sum, StateBuffer& slope) {
  kernels().stageSlope(kernelChain(), state.data(), sum, slope.data());
  ++counters().force_evaluations;
}

const StateBuffer& Rock4Stepper::runRecurrence(double h) {
  const auto& rows = method_->recurrences;
  const WeightedSlope first{h * rows[0].mu, first_slope_.data()};
  kernels().combine(kernelChain().pitch, begin().data(), {&first, 1}, inner_[0].data());
  StateBuffer* last = inner_.data();
  StateBuffer* next = &inner_[1];
  const StateBuffer* before = &begin();
  for (std::size_t j = 1; j < method_->recurrenceCount(); ++j) {
    kernels().recurrence(kernelChain(), last->data(), before->data(), rows[j].kappa, h * rows[j].mu,
                         next->data());
    ++counters().force_evaluations;
    before = last;
    std::swap(last, next);
  }
  return *last;
}

double Rock4Stepper::attempt(double h) {
  const StateBuffer& start = runRecurrence(h);
  const auto& c = method_->finish;
  const auto slope = [this](std::size_t i) { return slopes_[i].data(); };
  computeSlope(start, {}, slopes_[0]);
  const std::array<WeightedSlope, 1> second{{{h * c[0], slope(0)}}};
  computeSlope(start, {second.data(), 1}, slopes_[1]);
  const std::array<WeightedSlope, 2> third{{{h * c[1], slope(0)}, {h * c[2], slope(1)}}};
  computeSlope(start, {third.data(), 2}, slopes_[2]);
  const std::array<WeightedSlope, 3> fourth{
      {{h * c[3], slope(0)}, {h * c[4], slope(1)}, {h * c[5], slope(2)}}};
  computeSlope(start, {fourth.data(), 3}, slopes_[3]);
  const std::array<WeightedSlope, 4> all{
      {{h * c[6], slope(0)}, {h * c[7], slope(1)}, {h * c[8], slope(2)}, {h * c[9], slope(3)}}};
  kernels().combine(kernelChain().pitch, start.data(), {all.data(), 4}, end().data());
  computeSlope(end(), {}, slopes_[4]);
  std::array<WeightedSlope, 5> error{};
  for (std::size_t i = 0; i < 5; ++i) error[i] = {h * method_->error[i], slope(i)};
  return kernels()
      .largestChange(kernelChain().size, kernelChain().pitch, {error.data(), 5})
      .position;
}

// Cubic Hermite polynomial of the states and slopes at both ends.
void Rock4Stepper::interpolate(double fraction, State& state) const {
  const double t = fraction, rest = 1.0 - fraction;
  const double h = statistics().last_step;
  const StateBuffer& last_slope = slopes_.back();
  state.values() = (rest * rest * (1.0 + 2.0 * t)) * begin().values() +
                   (t * t * (3.0 - 2.0 * t)) * end().values() +
                   (h * t * rest * rest) * first_slope_.values() -
                   (h * t * t * rest) * last_slope.values();
}

}  // namespace spring_pendulum
