#include "integration/error_control/dense_output_integrator.hpp"

#include "base/checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace spring_pendulum {
namespace {

/// A collision takes a few steps of the shortest size. With more of them in a row than this, the
/// integration would not reach the next output time.
constexpr int kMostShortestSteps = 1000;

struct QuadraturePoint {
  double node;  ///< on [-1, 1]
  double weight;
};

/// Gauss-Legendre quadrature, exact up to degree 11. Its error is smaller than that of the dense
/// output.
/// M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, table 25.4.
constexpr std::array<QuadraturePoint, 6> kGaussLegendre{
    {{-0.932469514203152028, 0.171324492379170345},
     {-0.661209386466264514, 0.360761573048138608},
     {-0.238619186083196909, 0.467913934572691047},
     {0.238619186083196909, 0.467913934572691047},
     {0.661209386466264514, 0.360761573048138608},
     {0.932469514203152028, 0.171324492379170345}}};

}  // namespace

DenseOutputIntegrator::DenseOutputIntegrator(const Chain& chain,
                                             std::unique_ptr<DenseOutputStepper> stepper,
                                             bool track_dissipation)
    : stepper_(std::move(stepper)),
      constants_(chain),
      kernels_(fastestChainKernels()),
      held_(chain),
      energy_flow_(chain, track_dissipation) {}

void DenseOutputIntegrator::restart() {
  started_ = false;
  held_.restart();
  before_step_ = in_step_ = {};
}

DenseOutputIntegrator::Energies DenseOutputIntegrator::energiesOf(double fraction) {
  if (!energy_flow_.isNeeded()) return {};
  energy_flow_.reset();
  const KernelChain& chain = constants_.chain();
  const double half_time = 0.5 * fraction * step_length_;
  for (const auto& [node, weight] : kGaussLegendre) {
    const double inside = 0.5 * fraction * (1.0 + node);
    energy_flow_.add(kernels_, chain, stepper_->stateAt(inside), half_time * weight,
                     half_time * chain.spring.damping * weight,
                     [&](Eigen::Index spring) { return stepper_->tensionAt(spring, inside); });
  }
  return {energy_flow_.dissipated(), energy_flow_.supplied()};
}

void DenseOutputIntegrator::takeStep() {
  if (step_length_ > 0.0) {
    const Energies energies = energiesOf(1.0);
    before_step_.dissipated += energies.dissipated;
    before_step_.supplied += energies.supplied;
  }
  step_length_ = stepper_->step();
  shortest_steps_ = step_length_ > kShortestStep ? 0 : shortest_steps_ + 1;
  diverged_ = !(step_length_ > 0.0) || shortest_steps_ > kMostShortestSteps;
  step_begin_ = step_end_;
  // Compensated: the rounding errors of equal steps add up.
  lost_time_ += step_length_;
  step_end_ = step_begin_ + lost_time_;
  lost_time_ -= step_end_ - step_begin_;
}

void DenseOutputIntegrator::integrate(State& state, double time_step, std::int64_t steps) {
  integrateWithin(state, time_step, steps, std::numeric_limits<double>::infinity());
}

std::int64_t DenseOutputIntegrator::integrateWithin(State& state, double time_step,
                                                    std::int64_t steps, double most_work) {
  requireAdvance(constants_.chain().size, state.size(), time_step, steps);
  held_.begin(state, time_step);
  if (!started_) {
    stepper_->start(state);
    started_ = true;
    diverged_ = false;
    shortest_steps_ = 0;
    output_origin_ = 0.0;
    outputs_ = 0;
    step_begin_ = step_length_ = step_end_ = lost_time_ = 0.0;
  } else if (time_step != output_step_) {
    output_origin_ += static_cast<double>(outputs_) * output_step_;
    outputs_ = 0;
  }
  output_step_ = time_step;
  if (steps == 0) return 0;
  const double output_time = output_origin_ + static_cast<double>(outputs_ + steps) * time_step;
  while (!diverged_ && step_end_ < output_time) {
    // Without a limit, the statistics need not be collected in every step.
    if (std::isfinite(most_work) && work() >= most_work) return 0;
    takeStep();
  }
  outputs_ += steps;
  if (diverged_) {
    state.values()
        .bottomRows(state.size() - 1)
        .setConstant(std::numeric_limits<double>::quiet_NaN());
    held_.place(state.values(), steps);
    return steps;
  }
  const double fraction = std::min((output_time - step_begin_) / step_length_, 1.0);
  state.values() = stepper_->stateAt(fraction).values();
  held_.place(state.values(), steps);
  in_step_ = energiesOf(fraction);
  return steps;
}

}  // namespace spring_pendulum
