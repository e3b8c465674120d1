#include "simulation/reference_run.hpp"

#include "base/checks.hpp"
#include "model/chain_modes.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

/// Upper limits of the tolerance of the reference: in m, and relative to the length of the chain.
constexpr double kTolerance = 1e-10;
constexpr double kRelativeTolerance = 1e-9;
/// Tolerance of the reference, relative to the tolerance of the run.
constexpr double kToleranceShare = 1e-3;
/// Tolerance of the companion, relative to that of the reference.
constexpr double kCompanionTolerance = 100.0;
/// Uncertainty, in distances of the companion from the reference. Where stability limits the steps,
/// both errors can have the same direction: the reference was up to 2.5 distances off.
constexpr double kSafety = 3.0;
/// Change of the companion's start and smallest distance that can be resolved, relative to the largest
/// coordinate. The rounding errors of a run had the effect of a change of the start by up to 4e-15
/// (70,000 evaluations). With this value one in 640 measurements of chaotic motions exceeded its
/// uncertainty, by a factor of 1.6; without a moved start 50, by up to 55.
constexpr double kRounding = 3e-14;
/// Error of the companion, in its tolerances, above which a motion counts as sensitive. Measured on random
/// scenes with tolerances above 1e-10 m: at most 0.34 while perturbations had grown up to 100 times; at
/// least 0.3 in 99 % of 1031 runs that were over ten tolerances off after they had grown more.
constexpr double kSensitiveError = 0.3;
/// An uncertainty above this share of the length ends the measurement.
constexpr double kBelieved = 1e-3;
/// Least length to which errors are related, relative to the largest length of the chain so far.
constexpr double kShareOfLength = 0.01;
/// Growth of rounding errors above which the motion and not the rounding is to blame.
constexpr double kSensitiveGrowth = 100.0;

/// Work that is always allowed, s; see Integrator::work.
constexpr double kFreeWork = 0.12;
/// Longer chains are measured only on request, because a reference run would need much memory.
constexpr Eigen::Index kMostParticles = 100'000;

constexpr std::string_view kCostTooMuch = "a reference run would cost more than the run itself";

/// Damping rates, 1/s, above which stability can limit explicit steps, or implicit ones are cheaper.
constexpr double kFastRate = 100.0;
constexpr double kStiffRate = 1e4;

/// NaN if a position is not finite.
double largestDistance(const State& a, const State& b) {
  const auto difference = a.positions() - b.positions();
  if (!difference.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(difference.rowwise().squaredNorm().maxCoeff());
}

/// Returns the method of the companion; that of the reference is `Auto`. They differ if stability
/// limits the step size, because one method would then take the same steps with both tolerances.
std::string_view companionMethod(const Chain& chain) {
  const double rate = largestDampingRate(chain);
  if (rate < kFastRate) return "Auto";
  return rate < kStiffRate ? "Stabilized-Taylor-8" : "Radau-9";
}

/// Returns the state with every particle but the first moved by `change` m, each in another
/// direction. Without a drive, a chain on a vertical line stays on it, as does one on a horizontal line
/// without gravity: no error of a method leaves the line.
State moved(const Chain& chain, const State& state, double change) {
  const bool vertical = !chain.isDriven() && (state.x().array() == state.x()[0]).all() &&
                        (state.vx().array() == 0.0).all();
  const bool horizontal = !chain.isDriven() && chain.gravity() == 0.0 &&
                          (state.y().array() == state.y()[0]).all() &&
                          (state.vy().array() == 0.0).all();
  State result = state;
  double cosine = 1.0, sine = 0.0;  // of a direction that turns by 53 degrees per particle
  for (Eigen::Index i = 1; i < state.size(); ++i) {
    const double turned = 0.6 * cosine - 0.8 * sine;
    sine = 0.8 * cosine + 0.6 * sine;
    cosine = turned;
    if (!vertical) result.x()[i] += change * cosine;
    if (!horizontal) result.y()[i] += change * sine;
  }
  return result;
}

double roundingOf(const State& state, double length) {
  return kRounding * std::max(state.positions().cwiseAbs().maxCoeff(), length);
}

}  // namespace

ReferenceRun::ReferenceRun(const Chain& chain, const State& start, double run_tolerance,
                           bool always)
    : chain_(chain),
      length_(chainLength(chain, start)),
      rounding_(roundingOf(start, length_)),
      tolerance_(std::min(kTolerance, kRelativeTolerance * length_)),
      free_work_(always ? std::numeric_limits<double>::infinity() : kFreeWork),
      allowed_work_(free_work_),
      uncertainty_(rounding_) {
  if (run_tolerance > 0.0) tolerance_ = std::min(tolerance_, kToleranceShare * run_tolerance);
  tolerance_ = std::max(tolerance_, rounding_);
  if (start.size() > kMostParticles && !always) stop(kCostTooMuch);
  if (chain.size() < 2 && chain.isDriven()) stop("a single particle only follows its holder");
  if (isMeasuring()) start_ = start;
}

bool ReferenceRun::advance(double time_step, std::int64_t steps,
                           const std::function<bool()>& stop) {
  if (!isMeasuring() || gave_up_ || chain_.size() < 2) return true;
  if (trajectories_.empty()) {
    trajectories_.push_back({makeIntegrator("Auto", chain_, {tolerance_, false, 1}), start_});
    trajectories_.push_back({makeIntegrator(companionMethod(chain_), chain_,
                                            {kCompanionTolerance * tolerance_, false, 1}),
                             moved(chain_, start_, rounding_)});
  }
  bool stopped = false;
  const auto ends = [&] { return work() >= allowed_work_ || (stopped = stop && stop()); };
  for (Trajectory& trajectory : trajectories_) {
    if (gave_up_) break;
    gave_up_ = trajectory.integrator->advance(trajectory.state, time_step, steps, ends) < steps;
  }
  return !stopped;
}

double ReferenceRun::work() const {
  double work = work_at_stop_;
  for (const Trajectory& trajectory : trajectories_) work += trajectory.integrator->work();
  return work;
}

// The work at a frame does not depend on the parts of the frame, and it exceeds the allowed work if
// `advance` gave up inside the frame. So the parts do not matter.
void ReferenceRun::measure(double run_work) {
  if (!isMeasuring() || trajectories_.empty()) return;
  if (gave_up_ || work() >= allowed_work_) return stop(kCostTooMuch);
  allowed_work_ = std::max(free_work_, run_work);
  distance_ = largestDistance(trajectories_[0].state, trajectories_[1].state);
  if (std::isnan(distance_)) return stop("the reference run diverged");
  length_ = std::max(length_, kShareOfLength * springLengths(*state(), 0, chain_.size() - 1));
  rounding_ = std::max(rounding_, roundingOf(*state(), length_));
  uncertainty_ = kSafety * distance_ + rounding_;
  const double believed = kBelieved * length_;
  if (uncertainty_ <= believed) return;
  if (kSensitiveGrowth * rounding_ > believed)
    return stop(
        "positions are so large that their rounding errors matter; start nearer to the origin");
  stop("small errors grow so much that the true positions cannot be determined",
       VerdictKind::kSensitive);
}

bool ReferenceRun::isSensitive() const {
  // The start and the tolerance do not tell of coordinates that grow during the motion.
  const double tolerance = std::max(tolerance_, rounding_);
  return distance_ > kSensitiveError * kCompanionTolerance * tolerance;
}

const State* ReferenceRun::state() const {
  if (!isMeasuring() || gave_up_) return nullptr;
  return trajectories_.empty() ? &start_ : &trajectories_[0].state;
}

double ReferenceRun::errorOf(const State& state) const {
  requireSize(chain_.size(), state.size());
  const State* reference = this->state();
  return reference == nullptr ? std::numeric_limits<double>::quiet_NaN()
                              : largestDistance(state, *reference);
}

void ReferenceRun::stop(std::string_view reason, VerdictKind verdict) {
  verdict_ = verdict;
  reason_ = reason;
  uncertainty_ = std::numeric_limits<double>::quiet_NaN();
  work_at_stop_ = work();
  trajectories_.clear();
}

}  // namespace spring_pendulum
