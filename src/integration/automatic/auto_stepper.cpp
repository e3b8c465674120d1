#include "integration/automatic/auto_stepper.hpp"

#include "base/numbers.hpp"
#include "integration/implicit/radau_stepper.hpp"
#include "integration/taylor/stabilized_taylor_stepper.hpp"
#include "integration/taylor/taylor_stepper.hpp"
#include "integration/work.hpp"
#include "model/chain_modes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace spring_pendulum {
namespace {

/// Tolerances in m below which order 12 costs less than order 8. The second holds for damping rates
/// above kFastRate (1/s), where stability limits the steps and order 8 is cheaper.
constexpr double kTightTolerance = 1e-2;
constexpr double kTightToleranceIfFast = 1e-5;
constexpr double kFastRate = 100.0;
/// Damping rate in 1/s above which the implicit method is a candidate.
constexpr double kRateForImplicit = 1e3;
/// Damping rate in 1/s above which the implicit method is the only candidate: explicit methods are
/// unstable there with any step much longer than the shortest one.
constexpr double kRateForImplicitOnly = 1.0 / kShortestStep;
/// Share of the stability limit above which the motion counts as stiff for an explicit method.
constexpr double kStiffFrom = 0.25;
/// Least number of steps of the active method before a switch, so that its pace is known.
constexpr int kLeastSteps = 16;
/// Steps of a candidate in a race: first to find its step size, then to measure its pace.
constexpr int kWarmingUp = 6;
constexpr int kCounted = 6;
/// Work between two races, in units of the work of a race.
constexpr double kWorkPerRace = 25.0;
/// A method that has become slower by this factor since its race must race again.
constexpr double kSlower = 2.0;
/// Angular frequency in rad/s of a vibration so fast that its methods race even if it is hardly
/// damped: steps are so short that a race takes a small part of any run.
constexpr double kFastVibration = 1e3;
/// Work before the first race, about that of a race, in force evaluations.
constexpr double kWorkBeforeFirstRace = 500.0;
/// Longest chain for which inactive methods are kept. In longer chains they would take too much
/// memory, and making one again costs less than one of its steps.
constexpr Eigen::Index kKeepsUpTo = 10'000;
/// Least ratio of the paces for a switch.
constexpr double kHysteresis = 1.2;

template <typename Stepper, int... kOrder>
std::unique_ptr<DenseOutputStepper> make(const Chain& chain, double tolerance) {
  return std::make_unique<Stepper>(chain, kOrder..., tolerance);
}

}  // namespace

bool AutoStepper::Pace::isFasterThan(const Pace& other, double factor) const {
  return time * other.work > factor * other.time * work;
}

AutoStepper::AutoStepper(const Chain& chain, double tolerance)
    : chain_(chain),
      tolerance_(tolerance),
      fastest_rate_(largestDampingRate(chain)),
      vibrates_fast_(fastestVibration(chain) > kFastVibration) {
  const bool order_12 =
      tolerance < (fastest_rate_ > kFastRate ? kTightToleranceIfFast : kTightTolerance);
  explicit_limit_ = order_12 ? kTaylor12RealStabilityLimit : kTaylor8RealStabilityLimit;
  const bool implicit_only = fastest_rate_ >= kRateForImplicitOnly;
  successor_is_better_ = !order_12 && !implicit_only;
  const auto add = [&](std::string_view name, const NominalTime& cost, auto make_stepper) {
    const double relative_cost = cost.of(chain.size()) / kTaylorTime.of(chain.size());
    candidates_.push_back({name, relative_cost, make_stepper});
  };
  if (!implicit_only) {
    add(order_12 ? "Taylor-12" : "Taylor-8", kTaylorTime,
        order_12 ? make<TaylorStepper, 12> : make<TaylorStepper, 8>);
    add("Stabilized-Taylor-8", kStabilizedTaylor8Time, make<StabilizedTaylorStepper, 8>);
    add("Stabilized-Taylor-4", kStabilizedTaylor4Time, make<StabilizedTaylorStepper, 4>);
  }
  if (fastest_rate_ >= kRateForImplicit) add("Radau-9", kRadauTime, make<RadauStepper>);
  candidates_[0].stepper = candidates_[0].make(chain_, tolerance_);
}

DenseOutputStepper& AutoStepper::startedAt(Candidate& candidate, const State& state) {
  if (!candidate.stepper) candidate.stepper = candidate.make(chain_, tolerance_);
  candidate.stepper->start(state);
  return *candidate.stepper;
}

void AutoStepper::release(Candidate& candidate) {
  if (!candidate.stepper || chain_.size() <= kKeepsUpTo) return;
  candidate.earlier = evaluationsOf(candidate);
  candidate.stepper.reset();
}

void AutoStepper::start(const State& state) {
  if (active_ != 0) release(candidates_[active_]);
  active_ = 0;
  recent_ = {};
  recent_steps_ = 0;
  raced_ = {};
  race_work_ = kWorkBeforeFirstRace;
  work_before_race_ = kWorkBeforeFirstRace;
  last_step_ = 0.0;
  startedAt(candidates_[0], state);
}

// The difference is taken before the product. Its rounding then does not depend on earlier work, so
// a restarted run gives the same bits.
double AutoStepper::workSince(const Candidate& candidate, std::int64_t evaluations_before) {
  return candidate.work_per_evaluation *
         static_cast<double>(evaluationsOf(candidate) - evaluations_before);
}

std::int64_t AutoStepper::evaluationsOf(const Candidate& candidate) {
  const auto& stepper = candidate.stepper;
  return candidate.earlier + (stepper ? stepper->statistics().force_evaluations : 0);
}

bool AutoStepper::isStiff() const {
  return active_ != 0 || last_step_ * fastest_rate_ > kStiffFrom * explicit_limit_;
}

bool AutoStepper::isTimeForRace() {
  if (work_before_race_ <= 0.0) return true;
  if (recent_.work < race_work_) return false;
  if (raced_.isFasterThan(recent_, kSlower)) return true;
  recent_ = {};
  return false;
}

double AutoStepper::step() {
  if (recent_steps_ >= kLeastSteps) {
    if (active_ == 0 && successor_is_better_ && isStiff()) {
      readState();
      change(1);
      work_before_race_ = kWorkBeforeFirstRace;
    } else if (candidates_.size() > 1 && (vibrates_fast_ || isStiff()) && isTimeForRace()) {
      race();
    }
  }
  Candidate& candidate = candidates_[active_];
  const std::int64_t before = evaluationsOf(candidate);
  last_step_ = candidate.stepper->step();
  const double work = workSince(candidate, before);
  recent_.work += work;
  work_before_race_ -= work;
  recent_.time += last_step_;
  ++recent_steps_;
  ++candidate.steps;
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
  state_.values() = stateAt(1.0).values();
}

void AutoStepper::race() {
  readState();
  double work = 0.0;
  std::size_t fastest = active_;
  raced_ = recent_;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    if (i == active_) continue;
    const std::int64_t before = evaluationsOf(candidates_[i]);
    const Pace pace = paceOf(candidates_[i], state_);
    work += workSince(candidates_[i], before);
    release(candidates_[i]);
    if (pace.isFasterThan(raced_, kHysteresis)) {
      fastest = i;
      raced_ = pace;
    }
  }
  race_work_ = work;
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
  StepStatistics all{0, 0, last_step_};
  for (const Candidate& candidate : candidates_) {
    all.force_evaluations += evaluationsOf(candidate);
    all.accepted += candidate.steps;
  }
  return all;
}

double AutoStepper::workPerEvaluation() const {
  double work = 0.0;
  for (const Candidate& candidate : candidates_) work += workSince(candidate, 0);
  return work / static_cast<double>(std::max<std::int64_t>(1, statistics().force_evaluations));
}

std::string AutoStepper::report() const {
  std::string text;
  for (const Candidate& candidate : candidates_)
    if (candidate.steps > 0)
      text += fmt::format("{} for {}, ", candidate.name, counted(candidate.steps, "step"));
  return text + counted(switches_, "switch", "es");
}

}  // namespace spring_pendulum
