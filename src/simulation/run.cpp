#include "base/checks.hpp"
#include "base/numbers.hpp"
#include "base/stopwatch.hpp"
#include "integration/work.hpp"
#include "model/chain_modes.hpp"
#include "simulation/expected_memory.hpp"
#include "simulation/judge.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/simulation/run.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

/// Work of a run whose energy balance is always computed; it takes less than the run.
constexpr double kCheapWork = 0.05;  // s
/// Particles from which on Runge-Kutta kernels track the dissipated energy at a cost of less than 10 %.
constexpr Eigen::Index kLongChain = 100;
/// Largest number of parts of a frame: more than any display needs, few enough to avoid overflow.
constexpr double kMostParts = 1048576.0;
constexpr std::int64_t kMostThreads = 1024;

bool dissipationIsCheap(const Chain& chain, const Plan& plan) {
  const Method& method = plan.method;
  const double evaluations =
      static_cast<double>(plan.frames - 1) * static_cast<double>(plan.steps()) * method.stages;
  if (method.hasFixedStep())
    return (method.tableau != nullptr && chain.size() >= kLongChain) ||
           evaluations * kFixedStepTime.of(chain.size()) <= kCheapWork;
  // About twenty steps per second, and more if springs vibrate or stability limits the step size.
  const double rate = 20.0 + 0.5 * fastestVibration(chain) + 0.1 * largestDampingRate(chain);
  return rate * plan.step() * evaluations * kTaylorTime.of(chain.size()) <= kCheapWork;
}

/// Tolerance of an error-controlled method, m; 0 for fixed steps.
double toleranceOf(const Plan& plan) {
  return plan.method.get().hasFixedStep() ? 0.0 : plan.tolerance;
}

JudgeOptions judgeOptions(const Plan& plan, bool track) {
  const Method& method = plan.method;
  const bool is_known = method.name == "Velocity-Verlet" || method.name == "Semi-Implicit-Euler";
  return {track, method.symplectic ? plan.time_step : 0.0, toleranceOf(plan),
          is_known ? method.order : 0};
}

std::int64_t partsPerFrame(const Plan& plan, double display_interval) {
  // `sleep` is checked once per frame: states between the frames would not move.
  if (display_interval <= 0.0 || plan.sleep > 0.0) return 1;
  const double wanted = std::clamp(plan.timeOfFrame(1) / display_interval, 1.0, kMostParts);
  // The subtrahend ensures that rounding does not give a frame of exactly 3 intervals 4 parts.
  if (plan.method.get().hasFixedStep())
    return std::min(static_cast<std::int64_t>(std::ceil(wanted - 1e-9)), plan.steps());
  std::int64_t parts = 1;
  while (static_cast<double>(parts) < wanted - 1e-9) parts *= 2;
  return parts;
}

/// Gives a plan frames of this interval, s. If it is no whole number of fixed steps, they become shorter.
void keepFrames(Plan& plan, double interval) {
  plan.frame_interval = interval;
  if (std::abs(plan.timeOfFrame(1) - interval) <= 1e-12 * interval) return;
  plan.steps_per_frame =
      static_cast<std::int64_t>(std::clamp(std::ceil(interval / plan.time_step - 1e-9), 1.0, 1e9));
  plan.time_step = interval / static_cast<double>(plan.steps_per_frame);
}

/// Whether the speed of every particle is at most `most` m/s, and its current acceleration changes
/// the velocity by at most this in `duration` s, so that none is at a turning point.
bool isAtRest(const Chain& chain, const State& state, double duration, double most) {
  const auto exceeds = [&](double x, double y) { return !(x * x + y * y <= most * most); };
  PlaneVector<double> left{};
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    const auto right =
        i + 1 == state.size() ? PlaneVector<double>{} : springForceOn(chain, state, i);
    const double gain = duration * chain.inverseMasses()[i];
    const double rise = (right.y - left.y) * gain - duration * chain.gravity();
    const bool moves =
        exceeds(state.vx()[i], state.vy()[i]) || exceeds((right.x - left.x) * gain, rise);
    if (i > 0 && moves) return false;
    left = right;
  }
  return true;
}

}  // namespace

Run::Run(const Scene& scene, const Plan& plan, const RunOptions& options)
    : plan_(plan),
      options_(options),
      chain_(scene.chain()),
      start_(scene.state),
      first_frame_(scene.frame),
      state_(start_),
      track_dissipation_(
          chain_.isDissipative() &&
          (options.track_dissipation || dissipationIsCheap(chain_, plan.from(first_frame_)))) {
  checkPlan(plan);
  checkMemory(plan, chain_.size());
  if (!(options.display_interval >= 0.0)) throw InputError("display_interval must be at least 0 s");
  divideFrames();
  integrator_ = integratorOf(plan, chain_, track_dissipation_);
  begin(first_frame_, start_);  // refuses a start that is not finite
  start_ = state_;              // where P_1 is at rest
  if (!plan.method.get().hasFixedStep()) checkTolerance(plan.tolerance, chain_, start_);
}

Run::Run(Run&&) noexcept = default;
Run::~Run() = default;

void Run::divideFrames() {
  parts_ = partsPerFrame(plan_, options_.display_interval);
  const bool fixed_step = plan_.method.get().hasFixedStep();
  step_ = fixed_step ? plan_.time_step : plan_.frame_interval / static_cast<double>(parts_);
  steps_ = fixed_step ? plan_.steps_per_frame : parts_;
}

std::unique_ptr<Integrator> Run::integratorOf(const Plan& plan, const Chain& chain, bool tracks) {
  const int threads = static_cast<int>(std::min(plan.threads, kMostThreads));
  return makeIntegrator(plan.method, chain, {plan.tolerance, tracks, threads});
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
  stopped_ = true;  // also if `stop` throws
  if (!integrate(steps) || !advanceReference(steps)) return false;
  stopped_ = false;
  part_ = part % parts_;
  dissipated_ = dissipated_before_ + integrator_->dissipatedEnergy();
  supplied_ = supplied_before_ + integrator_->suppliedEnergy();
  if (part_ != 0) return true;
  ++frame_;
  judgeFrame(integrator_->work() - work_at_start_);
  if (!isShown()) return false;
  ++totals_.frames;
  if (asleep_) ++totals_.slept_frames;
  if (!asleep_ && plan_.method.get().hasFixedStep()) totals_.steps += steps_;
  return true;
}

bool Run::integrate(std::int64_t steps) {
  std::optional<Stopwatch> stopwatch;
  if (options_.measure_seconds) stopwatch.emplace(totals_.seconds);
  if (plan_.sleep > 0.0 && !chain_.isDriven() && sleeps())
    return !(options_.stop && options_.stop());
  return integrator_->advance(state_, step_, steps, options_.stop) == steps;
}

bool Run::sleeps() {
  const bool was_asleep = asleep_;
  asleep_ = isAtRest(chain_, state_, std::max(plan_.timeOfFrame(1), 1.0), plan_.sleep);
  if (was_asleep && !asleep_) {
    // The integrator keeps data from before the sleep. Its restart also clears the dissipated energy.
    dissipated_before_ += integrator_->dissipatedEnergy();
    integrator_->restart();
  }
  return asleep_;
}

bool Run::advanceReference(std::int64_t steps) {
  if (!reference_ || !reference_->isMeasuring() || !isFinite()) return true;
  const Stopwatch stopwatch(totals_.reference_seconds);
  return reference_->advance(step_, steps, options_.stop);
}

void Run::judgeFrame(double work) {
  if (reference_) reference_->measure(work);
  judge_->judge(time(), state_, dissipated_, reference_.get(), supplied_);
}

void Run::goTo(std::int64_t frame, const State& state) {
  begin(frame, state);
  changed_ = frame != first_frame_ || state_.values() != start_.values();
}

void Run::begin(std::int64_t frame, const State& state) {
  checkFirstFrame(plan_, frame);
  checkState(state);
  judge_ = std::make_unique<Judge>(chain_, state, judgeOptions(plan_, track_dissipation_),
                                   plan_.timeOfFrame(frame));
  state_ = state;  // before the old reference run ends, whose state it may be
  if (!chain_.isDriven()) state_.velocities().row(0).setZero();  // P_1 is fixed
  if (plan_.reference != ReferenceUse::kNever)
    reference_ = std::make_unique<ReferenceRun>(chain_, state_, toleranceOf(plan_),
                                                plan_.reference == ReferenceUse::kAlways);
  integrator_->restart();
  frame_ = frame;
  part_ = 0;
  started_ = stopped_ = asleep_ = false;
  dissipated_before_ = dissipated_ = supplied_before_ = supplied_ = 0.0;
  judgeFrame();
}

void Run::checkState(const State& state) const {
  requireSize(chain_.size(), state.size());
  for (Eigen::Index i = 0; i < state.size(); ++i)
    if (!state.values().row(i).allFinite())
      throw InputError(fmt::format("particle {}: position and velocity must be finite", i + 1));
}

void Run::change(const Plan& plan, const Constants& constants, const Drive& drive,
                 const State& state) {
  Plan next = plan_;
  next.method = plan.method;
  next.tolerance = plan.tolerance;
  const bool fixed_step = next.method.get().hasFixedStep();
  const bool other_control = fixed_step != plan_.method.get().hasFixedStep();
  if (other_control) keepFrames(next, plan_.timeOfFrame(1));
  checkPlan(next);
  if (other_control && part_ != 0)
    throw InputError("fixed steps and error control alternate at frames only");
  Chain chain = Chain(chain_.masses(), constants).drivenBy(drive);
  checkState(state);
  // A chain that has grown since can still be driven: else its held particles would run away.
  if (!fixed_step && (other_control || next.tolerance != plan_.tolerance))
    checkTolerance(next.tolerance, chain, state);
  const bool knows_dissipation = energyEntry().dissipated.has_value();
  auto integrator = integratorOf(next, chain, knows_dissipation);  // which may refuse the chain
  Judge judge = *judge_;
  supplied_before_ = supplied_ =
      judge.change(chain, state_, state, judgeOptions(next, knows_dissipation), supplied_,
                   integrator_->forceEvaluations() > 0);
  chain_ = std::move(chain);
  plan_ = next;
  state_ = state;
  track_dissipation_ = knows_dissipation;
  changed_ = true;
  *judge_ = std::move(judge);
  reference_.reset();
  if (other_control) divideFrames();
  dissipated_before_ = dissipated_;
  evaluations_before_ += integrator_->forceEvaluations();
  work_at_start_ -= integrator_->work();
  asleep_ = false;
  integrator_ = std::move(integrator);
}

bool Run::isShown() const {
  return judge_->isShown(plan_.on_divergence == OnDivergence::kContinue);
}

const Verdict& Run::verdict() const {
  return judge_->worst();
}

std::string Run::measurements() const {
  return judge_->measurements();
}

std::string Run::toleranceRemark() const {
  return judge_->toleranceRemark();
}

double Run::referenceWork() const {
  return reference_ ? reference_->work() : 0.0;
}

EnergyEntry Run::energyEntry() const {
  return isJudged() ? judge_->entry() : judge_->balanceOf(time(), state_, dissipated_, supplied_);
}

double Run::largestEnergyError() const {
  return judge_->largestEnergyError();
}

PositionError Run::positionError() const {
  PositionError error = judge_->positionError();
  if (!isJudged()) error.now = reference_ ? reference_->errorOf(state_) : PositionError{}.now;
  return error;
}

const State* Run::referenceState() const {
  return reference_ ? reference_->state() : nullptr;
}

std::string Run::closingLine(const std::string& output) const {
  const Method& method = plan_.method;
  const std::string report =
      evaluations_before_ > 0 && !method.hasFixedStep() ? "" : integrator_->report();
  return fmt::format(
      "{}{}: {}, {}{}, {}{}, {} integrating{}, {} reference run, {}, verdict: {}", method.name,
      report.empty() ? "" : " (" + report + ")", counted(chain_.size(), "particle"),
      counted(totals_.frames, "frame"),
      totals_.slept_frames > 0 ? fmt::format(" ({} at rest, not integrated)", totals_.slept_frames)
                               : "",
      method.hasFixedStep() ? counted(totals_.steps, "step") + ", " : "",
      counted(evaluations_before_ + integrator_->forceEvaluations(), "force evaluation"),
      durationText(totals_.seconds), output, durationText(totals_.reference_seconds),
      measurements(), toString(verdict().kind));
}

std::int64_t Run::stepOfPart(std::int64_t part) const {
  // part * steps / parts without overflow of the product.
  return part * (steps_ / parts_) + part * (steps_ % parts_) / parts_;
}

double Run::timeOfPart(std::int64_t part) const {
  return static_cast<double>(frame_ * steps_ + stepOfPart(part)) * step_;
}

}  // namespace spring_pendulum
