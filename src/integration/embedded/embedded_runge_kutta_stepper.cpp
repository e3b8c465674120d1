#include "integration/embedded/embedded_runge_kutta_stepper.hpp"

#include <algorithm>
#include <utility>

namespace spring_pendulum {
namespace {

/// Converts a velocity error to a position error, s.
constexpr double kVelocityTime = 0.1;

}  // namespace

EmbeddedRungeKuttaStepper::EmbeddedRungeKuttaStepper(const Chain& chain, const EmbeddedPair* pair,
                                                     double tolerance, const ChainKernels& kernels)
    : ErrorEstimatingStepper(chain, pair->share_of_tolerance * tolerance, pair->error_order,
                             kernels),
      pair_(*pair),
      inside_(chain.size()) {
  for (std::size_t i = 0; i < pair_.dense_slopes; ++i) slopes_.emplace_back(chain.size());
}

void EmbeddedRungeKuttaStepper::prepare(bool restarted) {
  if (!restarted) {
    std::swap(slopes_[0], slopes_[pair_.tableau.stages]);
    return;
  }
  kernels_.stageSlope(constants_.chain(), begin_.data(), {}, slopes_[0].data());
  ++statistics_.force_evaluations;
}

double EmbeddedRungeKuttaStepper::attempt(double h) {
  const ButcherTableau& tableau = pair_.tableau;
  for (std::size_t i = 1; i < tableau.stages; ++i) {
    kernels_.stageSlope(constants_.chain(), begin_.data(), StageSum(h, tableau.a[i], slopes_),
                        slopes_[i].data());
  }
  setEnd(carry_, StageSum(h, tableau.b, slopes_));
  kernels_.stageSlope(constants_.chain(), end_.data(), {}, slopes_[tableau.stages].data());
  statistics_.force_evaluations += static_cast<std::int64_t>(tableau.stages);
  const LargestChange change =
      kernels_.largestChange(begin_.size(), begin_.pitch(), StageSum(h, pair_.error, slopes_));
  // std::max may drop a NaN; the second term keeps it.
  return std::max(change.position, kVelocityTime * change.velocity) +
         0.0 * (change.position + change.velocity);
}

const StateBuffer& EmbeddedRungeKuttaStepper::stateInside(double fraction) const {
  const double h = statistics_.last_step;
  kernels_.combine(begin_.pitch(), begin_.data(),
                   StageSum(h, pair_.denseWeights(fraction), slopes_), inside_.data());
  return inside_;
}

}  // namespace spring_pendulum
