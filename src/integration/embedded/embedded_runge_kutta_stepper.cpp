#include "integration/embedded/embedded_runge_kutta_stepper.hpp"

#include "integration/kernels/stage_sum.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

/// Error whose square could underflow to 0, m.
constexpr double kNoError = 1e-150;

/// Converts a velocity error to a position error, s.
constexpr double kVelocityTime = 0.1;

}  // namespace

EmbeddedRungeKuttaStepper::EmbeddedRungeKuttaStepper(const Chain& chain, const EmbeddedPair* pair,
                                                     double tolerance, const ChainKernels& kernels)
    : ErrorEstimatingStepper(chain, pair->share_of_tolerance * tolerance, pair->error_order,
                             kernels),
      pair_(*pair),
      inside_(chain.size()) {
  for (std::size_t i = 0; i < std::max(pair_.dense_slopes, pair_.tableau.stages + 1); ++i) {
    slopes_.emplace_back(chain.size());
  }
}

void EmbeddedRungeKuttaStepper::prepare(bool restarted) {
  extra_slopes_known_ = false;
  if (!restarted) {
    std::swap(slopes_[0], slopes_[pair_.tableau.stages]);
    return;
  }
  kernels().stageSlope(kernelChain(), begin().data(), {}, slopes_[0].data());
  ++counters().force_evaluations;
}

double EmbeddedRungeKuttaStepper::attempt(double h) {
  const ButcherTableau& tableau = pair_.tableau;
  for (std::size_t i = 1; i < tableau.stages; ++i) {
    kernels().stageSlope(kernelChain(), begin().data(), StageSum(h, tableau.a[i], slopes_),
                         slopes_[i].data());
  }
  setEnd(carry(), StageSum(h, tableau.b, slopes_));
  kernels().stageSlope(kernelChain(), end().data(), {}, slopes_[tableau.stages].data());
  counters().force_evaluations += static_cast<std::int64_t>(tableau.stages);
  const double error = errorOf(pair_.error, h);
  if (!pair_.hasCoarseError() || error < kNoError) return error;
  const double coarse = errorOf(pair_.coarse_error, h);
  return error * (error / std::sqrt(error * error + 0.01 * coarse * coarse));
}

double EmbeddedRungeKuttaStepper::errorOf(const EmbeddedPair::Weights& weights, double h) const {
  const LargestChange change =
      kernels().largestChange(begin().size(), begin().pitch(), StageSum(h, weights, slopes_));
  // std::max may drop a NaN; the second term keeps it.
  return std::max(change.position, kVelocityTime * change.velocity) +
         0.0 * (change.position + change.velocity);
}

const StateBuffer& EmbeddedRungeKuttaStepper::stateInside(double fraction) const {
  const double h = statistics().last_step;
  if (!extra_slopes_known_) {
    for (std::size_t i = pair_.tableau.stages + 1; i < pair_.dense_slopes; ++i) {
      kernels().stageSlope(kernelChain(), begin().data(), StageSum(h, pair_.tableau.a[i], slopes_),
                           slopes_[i].data());
      ++counters().force_evaluations;
    }
    extra_slopes_known_ = true;
  }
  kernels().combine(begin().pitch(), begin().data(),
                    StageSum(h, pair_.denseWeights(fraction), slopes_), inside_.data());
  return inside_;
}

}  // namespace spring_pendulum
