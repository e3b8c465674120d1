#include "integration/driven_integrator.hpp"

#include "base/checks.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace spring_pendulum {
namespace {

/// Distance of the particle at rest from P_1, m: its spring never becomes short.
constexpr double kFarAway = 1e6;

}  // namespace

DrivenIntegrator::DrivenIntegrator(const Chain& chain, std::unique_ptr<Integrator> relative,
                                   bool fixed_step)
    : chain_(chain),
      relative_(std::move(relative)),
      fixed_step_(fixed_step),
      acceleration_(chain.springlessAcceleration(0)) {}

void DrivenIntegrator::restart() {
  relative_->restart();
  started_ = false;
}

void DrivenIntegrator::begin(const State& state) {
  if (size() == chain_.size()) {
    start_velocity_ = {state.vx()[0], state.vy()[0]};
    state_ = state;
  } else {
    state_ = State(chain_.size());
    state_.values().bottomRows(size()) = state.values();
    state_.x()[0] = state.x()[0] - kFarAway;
    state_.y()[0] = state.y()[0];
  }
  state_.vx().array() -= start_velocity_.x;
  state_.vy().array() -= start_velocity_.y;
  start_ = state_;
  origin_ = time_step_ = 0.0;
  steps_ = 0;
  start_difference_ = energyDifference();
  started_ = true;
}

PlaneVector<double> DrivenIntegrator::velocity() const {
  const double t = time();
  return {fused(t, acceleration_.x, start_velocity_.x),
          fused(t, acceleration_.y, start_velocity_.y)};
}

PlaneVector<double> DrivenIntegrator::displacement() const {
  const double t = time();
  return {t * fused(0.5 * t, acceleration_.x, start_velocity_.x),
          t * fused(0.5 * t, acceleration_.y, start_velocity_.y)};
}

void DrivenIntegrator::placeHeld() {
  const double t = time();
  for (const HeldParticle& held : chain_.drive().held) {
    const Eigen::Index i = held.particle;
    const double ax = held.acceleration.x - acceleration_.x;
    const double ay = held.acceleration.y - acceleration_.y;
    state_.x()[i] = fused(t, fused(0.5 * t, ax, start_.vx()[i]), start_.x()[i]);
    state_.y()[i] = fused(t, fused(0.5 * t, ay, start_.vy()[i]), start_.y()[i]);
    state_.vx()[i] = fused(t, ax, start_.vx()[i]);
    state_.vy()[i] = fused(t, ay, start_.vy()[i]);
  }
}

void DrivenIntegrator::integrate(State& state, double time_step, std::int64_t steps) {
  integrateWithin(state, time_step, steps, std::numeric_limits<double>::infinity());
}

std::int64_t DrivenIntegrator::integrateWithin(State& state, double time_step, std::int64_t steps,
                                               double most_work) {
  requireAdvance(size(), state.size(), time_step, steps);
  if (!started_) begin(state);
  if (time_step != time_step_) {
    origin_ = time();
    steps_ = 0;
    time_step_ = time_step;
  }
  std::int64_t completed = 0;
  while (completed < steps) {
    if (std::isfinite(most_work) && work() >= most_work) break;
    const std::int64_t wanted = fixed_step_ ? 1 : steps - completed;
    const std::int64_t taken = relative_->integrateWithin(state_, time_step, wanted, most_work);
    if (taken == 0) break;
    completed += taken;
    steps_ += taken;
    placeHeld();
  }
  if (completed == 0) return 0;
  const PlaneVector<double> moved = displacement(), speed = velocity();
  const auto from = state_.values().bottomRows(size());
  state.x().array() = from.col(0).array() + moved.x;
  state.y().array() = from.col(1).array() + moved.y;
  state.vx().array() = from.col(2).array() + speed.x;
  state.vy().array() = from.col(3).array() + speed.y;
  return completed;
}

double DrivenIntegrator::energyDifference() const {
  const PlaneVector<double> moved = displacement(), speed = velocity();
  const double gain = 0.5 * (speed.x * speed.x + speed.y * speed.y) + chain_.gravity() * moved.y;
  const std::ptrdiff_t anchor = chain_.firstSpring();
  double sum = 0.0;
  for (Eigen::Index i = 1; i < chain_.size(); ++i) {
    if (chain_.isHeld(i)) continue;
    const double x = state_.x()[i] - start_.x()[anchor], y = state_.y()[i] - start_.y()[anchor];
    const PlaneVector<double> springless = chain_.springlessAcceleration(i);
    // Accelerations by which the two potentials differ.
    const double ax = springless.x - acceleration_.x;
    const double ay = springless.y + chain_.gravity() - acceleration_.y;
    sum += chain_.masses()[i] *
           (gain + speed.x * state_.vx()[i] + speed.y * state_.vy()[i] + ax * x + ay * y);
  }
  return sum;
}

double DrivenIntegrator::suppliedEnergy() const {
  if (!started_) return 0.0;
  return relative_->suppliedEnergy() + (energyDifference() - start_difference_);
}

}  // namespace spring_pendulum
