#include "base/checks.hpp"
#include "model/chain_modes.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/simulation/reference_run.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>

namespace spring_pendulum {
namespace {

/// Upper limits of the tolerance of the reference: in m, and relative to the length of the chain.
constexpr double kTolerance = 1e-10;
constexpr double kRelativeTolerance = 1e-9;
/// Tolerance of the reference, relative to the tolerance of the run.
constexpr double kToleranceShare = 1e-3;
/// Tolerance of the other trajectories, and perturbation of the perturbed ones, both in tolerances
/// of the reference.
constexpr double kOtherTolerance = 100.0;
constexpr double kChange = 1000.0;
/// Uncertainty, in distances of the second trajectory from the reference. Their errors may have the
/// same direction: the reference was up to 2.5 distances off on light particles.
constexpr double kSafety = 3.0;
/// Smallest distance that can be resolved, relative to the largest coordinate.
constexpr double kRounding = 1e-14;

/// Work that is always allowed, see Integrator::work.
constexpr double kFreeWork = 0.12;  // s
/// Longer chains are measured only on request, because a reference run would need much memory.
constexpr Eigen::Index kMostParticles = 100'000;

/// Damping rates in 1/s above which stability can limit the steps of an explicit method, and above
/// which an implicit method is cheaper.
constexpr double kFastRate = 100.0;
constexpr double kStiffRate = 1e4;

double largestDistance(const State& a, const State& b) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const double dx = a.x()[i] - b.x()[i];
    const double dy = a.y()[i] - b.y()[i];
    const double square = dx * dx + dy * dy;
    largest = std::max(largest, square);
    if (std::isnan(square)) return square;
  }
  return std::sqrt(largest);
}

/// Returns the methods of the reference and the second trajectory. They differ if stability limits
/// the step size, because one method would then take the same steps with both tolerances.
std::pair<std::string_view, std::string_view> referenceMethods(const Chain& chain) {
  const double rate = chain.spring().damping * largestSpringMode(chain);
  if (rate < kFastRate) return {"Auto", "Auto"};
  if (rate < kStiffRate) return {"Auto", "Stabilized-Taylor-8"};
  return {"Auto", "Radau-9"};
}

/// Returns the state with every particle but the first moved by `change` m, each in another
/// direction. A chain on a vertical line stays on it: no error of a method leaves the line, so the
/// growth of a change that does would say nothing.
State perturbed(const State& state, double change) {
  const bool vertical =
      (state.x().array() == state.x()[0]).all() && (state.vx().array() == 0.0).all();
  State moved = state;
  double cosine = 1.0, sine = 0.0;  // of a direction that turns by 53 degrees per particle
  for (Eigen::Index i = 1; i < state.size(); ++i) {
    const double turned = 0.6 * cosine - 0.8 * sine;
    sine = 0.8 * cosine + 0.6 * sine;
    cosine = turned;
    if (!vertical) moved.x()[i] += change * cosine;
    moved.y()[i] += change * sine;
  }
  return moved;
}

}  // namespace

double chainLength(const Chain& chain, const State& start) {
  requireSize(chain.size(), start.size());
  const Eigen::Index springs = start.size() - 1;
  return std::max(static_cast<double>(springs) * chain.spring().rest_length,
                  0.1 * springLengths(start, 0, springs));
}

struct ReferenceRun::Trajectory {
  Trajectory(std::string_view method, const Chain& chain, State start, double tolerance)
      : integrator(makeIntegrator(method, chain, {tolerance, false, 1})), state(std::move(start)) {}

  double work() const { return integrator->work(); }

  std::unique_ptr<Integrator> integrator;
  State state;
};

ReferenceRun::ReferenceRun(const Chain& chain, const State& start, const ReferenceOptions& options)
    : chain_(chain),
      always_(options.always),
      measures_growth_(std::isfinite(options.run_tolerance)),
      believed_(kBelieved * chainLength(chain, start)) {
  const double extent = start.size() > 0 ? start.positions().cwiseAbs().maxCoeff() : 0.0;
  const double length = chainLength(chain, start);
  rounding_ = kRounding * std::max(extent, length);
  tolerance_ =
      std::min({kTolerance, kRelativeTolerance * length, kToleranceShare * options.run_tolerance});
  tolerance_ = std::max(tolerance_, rounding_);
  if (start.size() > kMostParticles && !always_) {
    stop(Status::kCostTooMuch);
    return;
  }
  start_ = start;
  restart();
}

ReferenceRun::~ReferenceRun() = default;
ReferenceRun::ReferenceRun(ReferenceRun&&) noexcept = default;
ReferenceRun& ReferenceRun::operator=(ReferenceRun&&) noexcept = default;

void ReferenceRun::restart() {
  trajectories_.clear();
  if (start_.size() == 0) return;  // too long to be measured
  state_ = start_;
  uncertainty_ = rounding_;
  measurements_ = 0;
  growth_ = measures_growth_ ? 1.0 : std::numeric_limits<double>::quiet_NaN();
  status_ = Status::kMeasuring;
}

void ReferenceRun::makeTrajectories() {
  const auto [first, second] = referenceMethods(chain_);
  const double other_tolerance = kOtherTolerance * tolerance_;
  trajectories_.emplace_back(first, chain_, start_, tolerance_);
  trajectories_.emplace_back(second, chain_, start_, other_tolerance);
  if (!measures_growth_) return;
  for (int i = 0; i < 2; ++i) {
    trajectories_.emplace_back(first, chain_, perturbed(start_, kChange * tolerance_),
                               other_tolerance);
  }
}

void ReferenceRun::advance(double time_step, std::int64_t steps, double run_work) {
  requireFinitePositive("time_step", time_step, "s");
  requireAtLeastZero("steps", steps);
  if (!isMeasuring() || start_.size() < 2) return;
  if (trajectories_.empty()) makeTrajectories();
  double left = allowedWork(run_work);
  for (const Trajectory& trajectory : trajectories_) left -= trajectory.work();
  for (Trajectory& trajectory : trajectories_) {
    left += trajectory.work();
    if (trajectory.integrator->advanceWithin(trajectory.state, time_step, steps, left) < steps) {
      stop(Status::kCostTooMuch);
      return;
    }
    left -= trajectory.work();
  }
  compare();
}

void ReferenceRun::compare() {
  const State& reference = trajectories_.front().state;
  uncertainty_ = kSafety * largestDistance(reference, trajectories_[1].state) + rounding_;
  if (uncertainty_ <= believed_) {
    state_ = reference;
  } else {
    stop(std::isfinite(uncertainty_) ? Status::kSensitive : Status::kFailed);
  }
}

void ReferenceRun::measureGrowth() {
  if (!measures_growth_ || trajectories_.empty()) return;
  const State& reference = trajectories_.front().state;
  const double change = kChange * tolerance_;
  Trajectory& late = trajectories_[3];
  growth_ = std::max(growth_, largestDistance(reference, trajectories_[2].state) / change);
  growth_ = std::max(growth_, largestDistance(reference, late.state) / change);
  ++measurements_;
  if ((measurements_ & (measurements_ - 1)) != 0) return;  // not a power of two
  late.state = perturbed(reference, change);
  late.integrator->restart();
}

double ReferenceRun::errorOf(const State& state) const {
  if (!isMeasuring()) return std::numeric_limits<double>::quiet_NaN();
  requireSize(chain_.size(), state.size());
  return largestDistance(state, state_);
}

void ReferenceRun::stop(Status status) {
  status_ = status;
  uncertainty_ = std::numeric_limits<double>::quiet_NaN();
  trajectories_.clear();
}

double ReferenceRun::allowedWork(double run_work) const {
  if (always_) return std::numeric_limits<double>::infinity();
  return std::max(kFreeWork, run_work);
}

}  // namespace spring_pendulum
