#include "integration/automatic/auto_stepper.hpp"

#include "base/numbers.hpp"
#include "integration/implicit/radau_stepper.hpp"
#include "integration/taylor/stabilized_taylor_stepper.hpp"
#include "integration/taylor/taylor_stepper.hpp"
#include "model/chain_modes.hpp"

#include <fmt/format.h>

namespace spring_pendulum {
namespace {

/// Tolerances in m below which order 12 costs less than order 8. The second holds for damping rates
/// above kFastRate (1/s), where stability limits the steps and order 8 is cheaper.
constexpr double kTightTolerance = 1e-2;
constexpr double kTightToleranceIfFast = 1e-5;
constexpr double kFastRate = 100.0;

/// Damping rate in 1/s above which the implicit method is a candidate.
constexpr double kRateForImplicit = 1e3;

/// Share of the stability limit above which the motion counts as stiff for an explicit method.
constexpr double kStiffFrom = 0.25;

/// Least number of steps of the active method before a switch, so that its pace is known.
constexpr int kLeastSteps = 16;

/// Steps of a candidate in a race: first to find its step size, then to measure its pace.
constexpr int kWarmingUp = 6;
constexpr int kCounted = 6;

/// Work between two races, in units of the work of a race.
constexpr double kWorkPerRace = 25.0;

/// Work before the first race, about that of a race, in force evaluations.
constexpr double kWorkBeforeFirstRace = 500.0;

/// Least ratio of the paces for a switch.
constexpr double kHysteresis = 1.2;

/// Cost of a force evaluation, in force evaluations of Taylor-8, measured for chains of 2 to 50
/// particles. It is higher with order 4, whose steps have fewer terms to share the work that is
/// done once per step.
constexpr double kTaylorWork = 1.0;
constexpr double kStabilizedTaylor4Work = 1.4;
constexpr double kStabilizedTaylor8Work = 1.15;

double fastestDampingRate(const Chain& chain) {
  return chain.spring().damping * largestSpringMode(chain);
}

template <int kOrder>
std::unique_ptr<DenseOutputStepper> makeTaylor(const Chain& chain, double tolerance) {
  return std::make_unique<TaylorStepper>(chain, kOrder, tolerance);
}

std::unique_ptr<DenseOutputStepper> makeRadau(const Chain& chain, double tolerance) {
  return std::make_unique<RadauStepper>(chain, tolerance);
}

template <int kOrder>
std::unique_ptr<DenseOutputStepper> makeStabilizedTaylor(const Chain& chain, double tolerance) {
  return std::make_unique<StabilizedTaylorStepper>(chain, kOrder, tolerance);
}

bool needsOrder12(const Chain& chain, double tolerance) {
  const bool fast = fastestDampingRate(chain) > kFastRate;
  return tolerance < (fast ? kTightToleranceIfFast : kTightTolerance);
}

}  // namespace

bool AutoStepper::Pace::isFasterThan(const Pace& other) const {
  return time * other.work > kHysteresis * other.time * work;
}

AutoStepper::AutoStepper(const Chain& chain, double tolerance, Eigen::Index keeps_up_to)
    : chain_(chain),
      tolerance_(tolerance),
      keeps_up_to_(keeps_up_to),
      fastest_rate_(fastestDampingRate(chain)) {
  const bool order_12 = needsOrder12(chain, tolerance);
  explicit_limit_ = order_12 ? kTaylor12RealStabilityLimit : kTaylor8RealStabilityLimit;
  successor_is_better_ = !order_12;
  candidates_.push_back({order_12 ? "Taylor-12" : "Taylor-8", kTaylorWork,
                         order_12 ? makeTaylor<12> : makeTaylor<8>});
  candidates_.push_back({"Stabilized-Taylor-8", kStabilizedTaylor8Work, makeStabilizedTaylor<8>});
  candidates_.push_back({"Stabilized-Taylor-4", kStabilizedTaylor4Work, makeStabilizedTaylor<4>});
  if (fastest_rate_ >= kRateForImplicit) {
    candidates_.push_back({"Radau-9", RadauStepper::workPerEvaluation(chain.size()), makeRadau});
  }
  candidates_[0].stepper = candidates_[0].make(chain_, tolerance_);
}

DenseOutputStepper& AutoStepper::startedAt(Candidate& candidate, const State& state) {
  if (!candidate.stepper) candidate.stepper = candidate.make(chain_, tolerance_);
  candidate.stepper->start(state);
  return *candidate.stepper;
}

void AutoStepper::release(Candidate& candidate) {
  if (!candidate.stepper || chain_.size() <= keeps_up_to_) return;
  const StepStatistics statistics = candidate.stepper->statistics();
  candidate.earlier_evaluations += statistics.force_evaluations;
  candidate.earlier_rejected += statistics.rejected;
  candidate.stepper.reset();
}

void AutoStepper::start(const State& state) {
  if (active_ != 0) release(candidates_[active_]);
  active_ = 0;
  recent_ = {};
  recent_steps_ = 0;
  work_before_race_ = kWorkBeforeFirstRace;
  last_step_ = 0.0;
  startedAt(candidates_[0], state);
}

// The difference is taken before the product. Its rounding then does not depend on earlier work, so
// a restarted run gives the same bits.
double AutoStepper::workSince(const Candidate& candidate, std::int64_t evaluations) {
  return candidate.work_per_evaluation *
         static_cast<double>(evaluationsOf(candidate) - evaluations);
}

bool AutoStepper::isStiff() const {
  return active_ != 0 || last_step_ * fastest_rate_ > kStiffFrom * explicit_limit_;
}

double AutoStepper::step() {
  if (recent_steps_ >= kLeastSteps && isStiff()) {
    if (active_ == 0 && successor_is_better_) {
      readState();
      change(1);
    } else if (recent_.work >= work_before_race_) {
      race();
    }
  }
  Candidate& candidate = candidates_[active_];
  const std::int64_t before = evaluationsOf(candidate);
  last_step_ = candidate.stepper->step();
  recent_.work += workSince(candidate, before);
  recent_.time += last_step_;
  ++recent_steps_;
  ++steps_;
  candidate.covered += last_step_;
  return last_step_;
}

AutoStepper::Pace AutoStepper::paceOf(Candidate& candidate, const State& state) {
  DenseOutputStepper& stepper = startedAt(candidate, state);
  for (int i = 0; i < kWarmingUp; ++i) {
    if (!(stepper.step() > 0.0)) return {};
  }
  Pace pace;
  const std::int64_t before = evaluationsOf(candidate);
  for (int i = 0; i < kCounted; ++i) {
    const double covered = stepper.step();
    if (!(covered > 0.0)) return {};
    pace.time += covered;
  }
  pace.work = workSince(candidate, before);
  return pace;
}

void AutoStepper::readState() {
  if (state_.size() == 0) state_ = State(chain_.size());
  active().stepper->interpolate(1.0, state_);
}

void AutoStepper::race() {
  readState();
  double work = 0.0;
  std::size_t fastest = active_;
  Pace best = recent_;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    if (i == active_) continue;
    const std::int64_t before = evaluationsOf(candidates_[i]);
    const Pace pace = paceOf(candidates_[i], state_);
    work += workSince(candidates_[i], before);
    release(candidates_[i]);
    if (pace.isFasterThan(best)) {
      fastest = i;
      best = pace;
    }
  }
  work_before_race_ = kWorkPerRace * work;
  change(fastest);
}

void AutoStepper::change(std::size_t to) {
  recent_ = {};
  recent_steps_ = 0;
  if (to == active_) return;
  release(candidates_[active_]);
  active_ = to;
  ++switches_;
  startedAt(candidates_[active_], state_);
}

StepStatistics AutoStepper::statistics() const {
  StepStatistics sum;
  for (const Candidate& candidate : candidates_) {
    const std::int64_t evaluations = evaluationsOf(candidate);
    sum.force_evaluations += evaluations;
    sum.extra_work += (candidate.work_per_evaluation - 1.0) * static_cast<double>(evaluations);
    sum.rejected += candidate.earlier_rejected;
    if (candidate.stepper) sum.rejected += candidate.stepper->statistics().rejected;
  }
  sum.accepted = steps_;
  sum.last_step = last_step_;
  return sum;
}

std::string AutoStepper::report() const {
  std::string text;
  for (const Candidate& candidate : candidates_) {
    if (candidate.covered == 0.0) continue;
    text += fmt::format("{} for {:.4g} s, ", candidate.name, candidate.covered);
  }
  return text + counted(switches_, "switch", "es");
}

}  // namespace spring_pendulum
