#include "integration/embedded/embedded_runge_kutta_stepper.hpp"

#include <algorithm>
#include <utility>

namespace spring_pendulum {
namespace {

constexpr const EmbeddedPair& kPair = kDormandPrince5;

/// The estimated error of a step is O(h^kErrorOrder).
constexpr int kErrorOrder = 5;

/// Largest estimated error of a step, in tolerances. With this value, the position error is at most 7
/// tolerances after 50 s of the weakly chaotic reference scene `horizontal_11` and far below one
/// tolerance on all other reference scenes.
constexpr double kShareOfTolerance = 2e-4;

/// Converts a velocity error to a position error, s.
constexpr double kVelocityTime = 0.1;

}  // namespace

EmbeddedRungeKuttaStepper::EmbeddedRungeKuttaStepper(const Chain& chain, double tolerance,
                                                     const ChainKernels& kernels)
    : ErrorEstimatingStepper(chain, kShareOfTolerance * tolerance, kErrorOrder, kernels),
      slopes_(kPair.tableau.stages + 1, StateBuffer(chain.size())),
      inside_(chain.size()) {}

void EmbeddedRungeKuttaStepper::prepare(bool restarted) {
  if (!restarted) return std::swap(slopes_[0], slopes_[kPair.tableau.stages]);
  kernels_.stageSlope(constants_.chain(), begin_.data(), kNoSlopes, slopes_[0].data());
  ++statistics_.force_evaluations;
}

double EmbeddedRungeKuttaStepper::attempt(double h) {
  const ButcherTableau& tableau = kPair.tableau;
  for (std::size_t i = 1; i < tableau.stages; ++i)
    kernels_.stageSlope(constants_.chain(), begin_.data(), stageSum(h, tableau.a[i], slopes_),
                        slopes_[i].data());
  setEnd(carry_, stageSum(h, tableau.b, slopes_));
  kernels_.stageSlope(constants_.chain(), end_.data(), kNoSlopes, slopes_[tableau.stages].data());
  statistics_.force_evaluations += static_cast<std::int64_t>(tableau.stages);
  const LargestChange change =
      kernels_.largestChange(begin_.size(), begin_.pitch(), stageSum(h, kPair.error, slopes_));
  // std::max may drop a NaN; the second term keeps it.
  return std::max(change.position, kVelocityTime * change.velocity) +
         0.0 * (change.position + change.velocity);
}

const StateBuffer& EmbeddedRungeKuttaStepper::stateInside(double fraction) const {
  const auto weights = kPair.denseWeights(fraction);
  kernels_.combine(begin_.pitch(), begin_.data(), stageSum(statistics_.last_step, weights, slopes_),
                   inside_.data());
  return inside_;
}

}  // namespace spring_pendulum
