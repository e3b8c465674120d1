#include "base/checks.hpp"
#include "base/numbers.hpp"
#include "base/stopwatch.hpp"
#include "simulation/expected_cost.hpp"
#include "simulation/options/scenario_options.hpp"
#include "simulation/sleep.hpp"
#include <spring_pendulum/integration/smallest_tolerance.hpp>
#include <spring_pendulum/model/equilibrium.hpp>
#include <spring_pendulum/simulation/run.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

/// Work of a run whose energy balance is always computed; it takes less than the run.
constexpr double kCheapWork = 0.05;  // s
/// Number of particles from which on the kernels of explicit Runge-Kutta methods track the dissipated
/// energy at a cost of less than 10 %.
constexpr Eigen::Index kLongChain = 100;
/// Largest number of parts of a frame: more than any display needs, few enough to avoid overflow.
constexpr double kMostParts = 1024.0;
constexpr std::int64_t kMostThreads = 1024;

bool dissipationIsCheap(const Method& method, const Chain& chain, const FrameSteps& frame,
                        std::int64_t frames) {
  if (method.hasFixedStep() && method.tableau != nullptr && chain.size() >= kLongChain) return true;
  return expectedWork(method, chain, frame, frames) <= kCheapWork;
}

/// Tolerance of an error-controlled method, m; 0 for fixed steps.
double toleranceOf(const Scenario& scenario) {
  return scenario.method.get().hasFixedStep() ? 0.0 : scenario.tolerance;
}

/// Number of states shown per frame.
std::int64_t partsPerFrame(const Scenario& scenario, double display_interval) {
  // `sleep` is checked once per frame: states between the frames would not move.
  if (display_interval <= 0.0 || scenario.sleep > 0.0) return 1;
  const FrameSteps frame = frameSteps(scenario);
  const double wanted = std::clamp(frame.timeOfFrame(1) / display_interval, 1.0, kMostParts);
  // The subtrahend ensures that rounding does not give a frame of exactly 3 intervals 4 parts.
  if (scenario.method.get().hasFixedStep()) {
    return std::min(static_cast<std::int64_t>(std::ceil(wanted - 1e-9)), frame.steps);
  }
  std::int64_t parts = 1;
  while (static_cast<double>(parts) < wanted - 1e-9) parts *= 2;
  return parts;
}

/// Gives a scenario frames of this interval, s. If it is no whole number of fixed steps, they become shorter.
void keepFrames(Scenario& scenario, double interval) {
  scenario.frame_interval = interval;
  if (std::abs(frameSteps(scenario).timeOfFrame(1) - interval) <= 1e-12 * interval) return;
  scenario.steps_per_frame =
      static_cast<std::int64_t>(std::min(std::ceil(interval / scenario.time_step), 1e9));
  scenario.time_step = interval / static_cast<double>(scenario.steps_per_frame);
}

const Scenario& checked(const Scenario& scenario, std::int64_t first_frame) {
  checkScenario(scenario);
  checkFirstFrame(scenario, first_frame);
  return scenario;
}

}  // namespace

State startOf(const Scenario& scenario, const Chain& chain, const Particles& particles) {
  const bool at_rest = scenario.start == Start::kAtRest && particles.frame == 0;
  return at_rest ? equilibrium(chain, particles.state) : particles.state;
}

Run::Run(const Scenario& scenario, const Particles& particles, const RunOptions& options)
    : scenario_(checked(scenario, particles.frame)),
      options_(options),
      chain_(scenario.chainOf(particles.masses)),
      start_(startOf(scenario, chain_, particles)),
      first_frame_(particles.frame),
      state_(start_),
      frame_steps_(frameSteps(scenario)),
      track_dissipation_(
          chain_.isDissipative() &&
          (options.track_dissipation ||
           dissipationIsCheap(scenario.method, chain_, frame_steps_, scenario.frames))),
      judge_(chain_, start_, judgeOptions(first_frame_)),
      frame_(first_frame_) {
  checkMemory(scenario, chain_.size());
  if (!scenario.method.get().hasFixedStep()) checkTolerance(scenario.tolerance, chain_, start_);
  setFrameSteps();
  makeIntegrator();
  startReference(start_);
  judgeFrame();
}

JudgeOptions Run::judgeOptions(std::int64_t first_frame) const {
  const Method& method = scenario_.method;
  return {track_dissipation_, method.symplectic ? scenario_.time_step : 0.0, toleranceOf(scenario_),
          frameSteps(scenario_).timeOfFrame(first_frame)};
}

void Run::setFrameSteps() {
  frame_steps_ = frameSteps(scenario_);
  parts_ = partsPerFrame(scenario_, options_.display_interval);
  if (scenario_.method.get().hasFixedStep()) return;
  frame_steps_ = {scenario_.frame_interval / static_cast<double>(parts_), parts_};
}

void Run::startReference(const State& start) {
  if (scenario_.reference == ReferenceUse::kNever) return;
  const ReferenceOptions reference{toleranceOf(scenario_),
                                   scenario_.reference == ReferenceUse::kAlways};
  reference_.emplace(chain_, start, reference);
}

void Run::makeIntegrator() {
  const int threads = static_cast<int>(std::min(scenario_.threads, kMostThreads));
  integrator_ = spring_pendulum::makeIntegrator(scenario_.method, chain_,
                                                {scenario_.tolerance, track_dissipation_, threads});
}

bool Run::advance() {
  return advanceTo(parts_);
}

bool Run::advancePart() {
  return advanceTo(part_ + 1);
}

bool Run::advanceTo(std::int64_t part) {
  if (!started_) {
    started_ = true;
    work_at_start_ = integrator_->work();
    if (isShown()) ++totals_.frames;
    return isShown();
  }
  if (isOver()) return false;
  const std::int64_t steps = stepOfPart(part) - stepOfPart(part_);
  stopped_ = !integrate(steps) || !advanceReference(steps);
  if (stopped_) return false;
  part_ = part % parts_;
  dissipated_ = dissipated_before_ + integrator_->dissipatedEnergy();
  supplied_ = supplied_before_ + integrator_->suppliedEnergy();
  if (part_ != 0) return true;
  ++frame_;
  work_ = integrator_->work() - work_at_start_;
  judgeFrame();
  if (!isShown()) return false;
  ++totals_.frames;
  ++(asleep_ ? totals_.slept_frames : totals_.integrated_frames);
  return true;
}

bool Run::integrate(std::int64_t steps) {
  std::optional<Stopwatch> stopwatch;
  if (options_.measure_seconds) stopwatch.emplace(totals_.seconds);
  if (scenario_.sleep > 0.0 && !chain_.isDriven() && sleeps())
    return !(options_.stop && options_.stop());
  return integrator_->advance(state_, frame_steps_.time_step, steps, options_.stop) == steps;
}

bool Run::sleeps() {
  if (isAtRest(chain_, state_, frame_steps_.timeOfFrame(1), scenario_.sleep)) {
    asleep_ = true;
    return true;
  }
  if (asleep_) {
    // The integrator keeps data from before the sleep. Its restart also clears the dissipated energy.
    dissipated_before_ += integrator_->dissipatedEnergy();
    integrator_->restart();
    asleep_ = false;
  }
  return false;
}

bool Run::advanceReference(std::int64_t steps) {
  if (!reference_ || !reference_->isMeasuring()) return true;
  const Stopwatch stopwatch(totals_.reference_seconds);
  return reference_->advance(frame_steps_.time_step, steps, options_.stop);
}

void Run::judgeFrame() {
  if (reference_) reference_->measure(work_);
  judge_.judge(time(), state_, dissipated_, reference_ ? &*reference_ : nullptr, supplied_);
}

void Run::reset() {
  if (changed_) {
    judge_ = Judge(chain_, start_, judgeOptions(first_frame_));
    startReference(start_);
    changed_ = false;
  } else {
    judge_.restart();
    if (reference_) reference_->restart();
  }
  begin(first_frame_, start_);
}

void Run::goTo(std::int64_t frame, const State& state) {
  checkFirstFrame(scenario_, frame);
  checkState(state);
  changed_ = true;
  judge_ = Judge(chain_, state, judgeOptions(frame));
  startReference(state);
  begin(frame, state);
}

void Run::begin(std::int64_t frame, const State& state) {
  integrator_->restart();
  state_ = state;
  frame_ = frame;
  part_ = 0;
  started_ = stopped_ = asleep_ = false;
  dissipated_before_ = dissipated_ = supplied_before_ = supplied_ = work_ = 0.0;
  judgeFrame();
}

void Run::checkState(const State& state) const {
  requireSize(chain_.size(), state.size());
  if (!state.values().allFinite()) throw InputError("the state has numbers that are not finite");
}

void Run::change(const Scenario& scenario, const Drive& drive, const State& state) {
  Scenario next = scenario_;
  next.method = scenario.method;
  next.tolerance = scenario.tolerance;
  next.stiffness = scenario.stiffness;
  next.damping = scenario.damping;
  next.rest_length = scenario.rest_length;
  next.gravity = scenario.gravity;
  next.air_drag = scenario.air_drag;
  const bool fixed_step = next.method.get().hasFixedStep();
  const bool other_control = fixed_step != scenario_.method.get().hasFixedStep();
  if (other_control) keepFrames(next, frameSteps(scenario_).timeOfFrame(1));
  checkScenario(next);
  if (other_control && part_ != 0)
    throw InputError("fixed steps and error control alternate at frames only");
  Chain chain = next.chainOf(chain_.masses()).drivenBy(drive);
  checkState(state);
  if (!fixed_step) checkTolerance(next.tolerance, chain, state);
  const bool knows_dissipation = track_dissipation_ || (!chain_.isDissipative() && !changed_);
  EnergyBalance balance = judge_.balance();
  const double supplied = balance.change(chain, state_, state, knows_dissipation, supplied_);

  chain_ = std::move(chain);
  scenario_ = next;
  state_ = state;
  track_dissipation_ = knows_dissipation;
  changed_ = true;
  judge_.change(chain_, std::move(balance), judgeOptions(first_frame_));
  if (reference_) reference_->stopAtChange();
  if (other_control) setFrameSteps();
  dissipated_before_ = dissipated_;
  supplied_before_ = supplied_ = supplied;
  evaluations_before_ += integrator_->forceEvaluations();
  work_at_start_ -= integrator_->work();
  asleep_ = false;
  makeIntegrator();
}

bool Run::isOver() const {
  return stopped_ || frame_ >= scenario_.frames - 1 || !isShown();
}

bool Run::isShown() const {
  return judge_.isShown(scenario_.on_divergence == OnDivergence::kContinue);
}

EnergyEntry Run::energyEntry() const {
  return isAtFrame() ? judge_.entry()
                     : judge_.balance().entry(time(), state_, dissipated_, supplied_);
}

PositionError Run::positionError() const {
  PositionError error = judge_.positionError();
  if (isAtFrame()) return error;
  error.now = reference_ ? reference_->errorOf(state_) : std::numeric_limits<double>::quiet_NaN();
  return error;
}

const State* Run::referenceState() const {
  return reference_ ? reference_->state() : nullptr;
}

std::string Run::closingLine(const std::string& output) const {
  const Method& method = scenario_.method;
  const std::string report = integrator_->report();
  return fmt::format(
      "{}{}: {}, {}{}, {}{}, {} integrating{}, {} reference run, {}, verdict: {}", method.name,
      report.empty() ? "" : " (" + report + ")", counted(chain_.size(), "particle"),
      counted(totals_.frames, "frame"),
      totals_.slept_frames > 0 ? fmt::format(" ({} at rest, not integrated)", totals_.slept_frames)
                               : "",
      method.hasFixedStep() ? counted(totals_.integrated_frames * frame_steps_.steps, "step") + ", "
                            : "",
      counted(evaluations_before_ + integrator_->forceEvaluations(), "force evaluation"),
      durationText(totals_.seconds), output, durationText(totals_.reference_seconds),
      measurements(), toString(verdict().kind));
}

std::int64_t Run::stepOfPart(std::int64_t part) const {
  // part * steps / parts without overflow of the product.
  const std::int64_t quotient = frame_steps_.steps / parts_;
  const std::int64_t remainder = frame_steps_.steps % parts_;
  return part * quotient + part * remainder / parts_;
}

double Run::timeOfPart(std::int64_t part) const {
  return static_cast<double>(frame_ * frame_steps_.steps + stepOfPart(part)) *
         frame_steps_.time_step;
}

}  // namespace spring_pendulum
