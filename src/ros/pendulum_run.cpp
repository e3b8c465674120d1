#include "ros/pendulum_run.hpp"

#include "io/program/interruption.hpp"
#include "simulation/interruptible.hpp"
#include "simulation/sleep.hpp"

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

/// Largest number of parts of a frame: more than any display needs, few enough to avoid overflow.
constexpr double kMostParts = 1024.0;

/// Number of states shown per frame.
std::int64_t partsPerFrame(const FrameSteps& frame, bool fixed_step, double display_interval) {
  if (display_interval <= 0.0) return 1;
  const double wanted = std::clamp(frame.timeOfFrame(1) / display_interval, 1.0, kMostParts);
  if (fixed_step) {
    // The subtrahend ensures that rounding does not give a frame of exactly 3 intervals 4 parts.
    return std::min(static_cast<std::int64_t>(std::ceil(wanted - 1e-9)), frame.steps);
  }
  std::int64_t parts = 1;
  while (static_cast<double>(parts) < wanted - 1e-9) parts *= 2;
  return parts;
}

}  // namespace

PendulumRun::PendulumRun(const Scenario& scenario, const Particles& particles, bool track_energy,
                         double display_interval)
    : scenario_(scenario),
      chain_(particles.masses, scenario.spring(), scenario.gravity),
      start_(particles.state),
      state_(particles.state),
      frame_steps_(frameSteps(scenario)),
      monitor_(scenario, chain_, start_, track_energy),
      integrator_(std::make_unique<SleepingIntegrator>(
          makeInterruptible(scenario, chain_, start_, monitor_.tracksDissipation(),
                            [] { return interruption() != 0; }),
          chain_, scenario.sleep)) {
  const bool fixed_step = scenario.method.get().hasFixedStep();
  // `sleep` is checked once per call of `advance`: more calls could change the frames.
  if (scenario.sleep == 0.0) parts_ = partsPerFrame(frame_steps_, fixed_step, display_interval);
  if (!fixed_step) {
    frame_steps_ = {scenario.frame_interval / static_cast<double>(parts_), parts_};
  }
  judgeFrame();
}

void PendulumRun::advance(bool in_between) {
  const std::int64_t target = in_between ? part_ + 1 : parts_;
  const std::int64_t steps = stepOfPart(target) - stepOfPart(part_);
  integrator_->advance(state_, frame_steps_.time_step, steps);
  monitor_.follow(frame_steps_.time_step, steps);
  part_ = target % parts_;
  if (part_ != 0) return;
  ++frame_;
  judgeFrame();
}

void PendulumRun::reset() {
  state_ = start_;
  integrator_->restart();
  monitor_.restart();
  frame_ = 0;
  part_ = 0;
  judgeFrame();
}

void PendulumRun::judgeFrame() {
  monitor_.judge(time(), state_, *integrator_);
}

EnergyEntry PendulumRun::energyEntry() const {
  return atFrame() ? monitor_.energyEntry() : monitor_.energyEntry(time(), state_, *integrator_);
}

PositionError PendulumRun::positionError() const {
  PositionError error = monitor_.positionError();
  if (!atFrame()) error.now = monitor_.positionErrorOf(state_);
  return error;
}

const State* PendulumRun::referenceState() const {
  const ReferenceRun* reference = monitor_.reference();
  return reference == nullptr ? nullptr : &reference->state();
}

void PendulumRun::writeTo(RunFiles& files) const {
  if (atFrame() && isShown()) files.write(frame_, state_, energyEntry(), positionError().now);
  if (isOver()) files.finish();
}

std::int64_t PendulumRun::steps() const {
  return frame_ * frame_steps_.steps + stepOfPart(part_);
}

std::int64_t PendulumRun::stepOfPart(std::int64_t part) const {
  // part * steps / parts without overflow of the product.
  const std::int64_t quotient = frame_steps_.steps / parts_;
  const std::int64_t remainder = frame_steps_.steps % parts_;
  return part * quotient + part * remainder / parts_;
}

double PendulumRun::timeOfPart(std::int64_t part) const {
  return static_cast<double>(frame_ * frame_steps_.steps + stepOfPart(part)) *
         frame_steps_.time_step;
}

}  // namespace spring_pendulum
