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
/// Damping rate in 1/s above which the implicit method is a candidate in every race.
constexpr double kRateForImplicit = 1e3;
/// Damping rate in 1/s above which the implicit method is the only candidate: explicit methods are
/// unstable there with any step much longer than the shortest one.
constexpr double kRateForImplicitOnly = 1.0 / kShortestStep;
/// Share of the stability limit above which the motion counts as stiff for an explicit method.
constexpr double kStiffFrom = 0.25;
/// Least number of steps of the active method before a switch, so that its pace is known.
constexpr int kLeastSteps = 16;
/// Steps of a candidate in a race that measure its pace, after `Candidate::warming_up` others.
constexpr int kCounted = 6;
constexpr Eigen::Index kMostWarmingUp = 20'000;  // particles times steps: a race of up to 0.05 s
/// Work between two races, in units of the work of a race. Without fast damping, Radau-9 wins only after
/// its numerical damping has ended the vibrations: there, it has its own interval, and its races grow.
constexpr double kWorkPerRace = 25.0;
/// A method that has become slower by this factor since its race must race again.
constexpr double kSlower = 2.0;
/// Angular frequency in rad/s of a vibration so fast that all methods race even if it is hardly
/// damped: steps are so short that a race takes a small part of any run.
constexpr double kFastVibration = 1e3;
/// Work before the first race, about that of a race, in force evaluations.
constexpr double kWorkBeforeFirstRace = 500.0;
/// Longest chain for which inactive methods are kept. In longer chains they would take too much
/// memory (1 GB for 1e6 particles), and making one again costs less than one of its steps.
constexpr Eigen::Index kKeepsUpTo = 10'000;
/// Least ratio of the paces for a switch, so that two equally good methods do not alternate.
constexpr double kHysteresis = 1.2;

template <typename Stepper, int... kOrder>
std::unique_ptr<DenseOutputStepper> make(const Chain& chain, double tolerance) {
  return std::make_unique<Stepper>(chain, kOrder..., tolerance);
}

}  // namespace

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
  if (fastest_rate_ >= kRateForImplicit || vibrates_fast_)
    add("Radau-9", kRadauTime, make<RadauStepper>);
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
  race_work_ = races_from_ = kWorkBeforeFirstRace;
  work_ = 0.0;
  const bool seldom = vibrates_fast_ && fastest_rate_ < kRateForImplicit;
  candidates_.back().warming_up = candidates_[0].warming_up;
  candidates_.back().races_from = seldom ? kWorkPerRace * kWorkBeforeFirstRace : 0.0;
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
  if (work_ >= races_from_) return true;
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
      races_from_ = work_ + kWorkBeforeFirstRace;
    } else if (candidates_.size() > 1 && (vibrates_fast_ || isStiff()) && isTimeForRace()) {
      race();
    }
  }
  Candidate& candidate = candidates_[active_];
  const std::int64_t before = evaluationsOf(candidate);
  last_step_ = candidate.stepper->step();
  const double work = workSince(candidate, before);
  recent_.work += work;
  work_ += work;
  recent_.time += last_step_;
  ++recent_steps_;
  ++candidate.steps;
  return last_step_;
}

AutoStepper::Pace AutoStepper::paceOf(Candidate& candidate, const State& state) {
  DenseOutputStepper& stepper = startedAt(candidate, state);
  Pace pace;
  std::int64_t before = 0;
  for (int i = -candidate.warming_up; i < kCounted; ++i) {
    if (i == 0) before = evaluationsOf(candidate);
    const double covered = stepper.step();
    if (!(covered > 0.0)) return {};
    if (i >= 0) pace.time += covered;
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
    Candidate& candidate = candidates_[i];
    if (i == active_ || work_ < candidate.races_from) continue;
    const std::int64_t before = evaluationsOf(candidate);
    const Pace pace = paceOf(candidate, state_);
    const double cost = workSince(candidate, before);
    release(candidate);
    const bool wins = pace.isFasterThan(raced_, kHysteresis);
    if (wins || candidate.races_from == 0.0) work += cost;
    if (candidate.races_from > 0.0) {
      candidate.races_from = work_ + kWorkPerRace * cost;
      if (candidate.warming_up * chain_.size() < kMostWarmingUp) candidate.warming_up *= 2;
    }
    if (wins) {
      fastest = i;
      raced_ = pace;
    }
  }
  race_work_ = work;
  races_from_ = work_ + kWorkPerRace * work;
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
