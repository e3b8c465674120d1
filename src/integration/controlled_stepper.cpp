#include <spring_pendulum/integration/controlled_stepper.hpp>
#include <spring_pendulum/model/energy.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace spring_pendulum {

ControlledStepper::ControlledStepper(const Chain& chain, const IntegratorOptions& options,
                                     double allowed_error, int error_order)
    : chain_(chain),
      track_dissipation_(options.track_dissipation),
      allowed_error_(allowed_error),
      error_order_(error_order),
      constants_(chain_),
      kernels_(fastestChainKernels()),
      controller_(error_order),
      begin_(chain.size()),
      end_(chain.size()),
      sample_(chain.size()) {}

void ControlledStepper::start(const State& state) {
  end_.values() = state.values();
  controller_.restart();
  restarted_ = true;
  // Short for any scene at this tolerance; the controller makes five times as much of it a step.
  next_step_ = std::max(0.01 * root(allowed_error_, error_order_), kShortestStep);
}

double ControlledStepper::step() {
  std::swap(begin_, end_);
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

double ControlledStepper::dissipated(double fraction) const {
  if (!track_dissipation_) return 0.0;
  // Three nodes on [-1, 1], exact for polynomials of degree 5.
  const double node = std::sqrt(0.6);
  const std::array<std::pair<double, double>, 3> rule{
      {{-node, 5.0 / 18.0}, {0.0, 8.0 / 18.0}, {node, 5.0 / 18.0}}};
  double mean_power = 0.0;
  for (const auto& [position, weight] : rule) {
    interpolate(fraction * 0.5 * (1.0 + position), sample_);
    mean_power += weight * dissipatedPower(chain_, sample_);
  }
  return fraction * statistics_.last_step * mean_power;
}

}  // namespace spring_pendulum
