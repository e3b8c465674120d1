#include "integration/taylor/taylor_stepper.hpp"

#include "integration/error_control/step_size_controller.hpp"
#include "model/chain_modes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

/// Allowed growth rate of the velocity error in units of the tolerance, 1/s². With this value, the
/// position error is at most 2.7 tolerances after 50 s of the weakly chaotic reference scene
/// `horizontal_11` and far below one tolerance on all other reference scenes.
constexpr double kErrorRate = 0.01;

/// Angular frequency in rad/s up to which a velocity error counts as if it lasted. In a faster
/// vibration it moves a particle by 1/frequency only.
constexpr double kSlowVibration = 100.0;

/// Growth from one coefficient to the next, 1/s, if the coefficients do not show it: larger than in
/// any motion.
constexpr double kUnknownGrowth = 1e4;

/// A coefficient too small to limit the step size. Dividing by a smaller one could overflow.
constexpr double kNoMotion = 1e-200;

/// Least growth within a step for which the coefficients can show it. On the reference scenes it is above
/// 0.02 at every tolerance; less is a gap in the series, filled by rounding errors.
constexpr double kLeastGrowthInStep = 1e-3;

/// Steps shorter than this, in s, carry their rounding errors to the next such step: the motion in one of them
/// can be less than a rounding error.
constexpr double kShortStep = 1e-8;

/// Square of the growth from one coefficient to the next that two of them show, 1/s²; negative where one
/// of them vanishes, so that they show none.
double squaredGrowth(double later, double earlier) {
  return later > 0.0 && earlier > 0.0 ? later / earlier : -1.0;
}

/// Step for which the first omitted term, extrapolated with this growth, has the allowed size.
double stepForGrowth(const LastCoefficients& last, double growth, std::ptrdiff_t order,
                     double allowed_rate) {
  // next = max(size[0] growth, size[1] growth², size[2] growth³, size[3] growth⁴)
  double next = 0.0;
  for (std::size_t back = 4; back-- > 0;) next = growth * std::max(next, last.size[back]);
  if (next < kNoMotion) return kLongestStep;
  return std::clamp(
      root(allowed_rate * static_cast<double>(order + 1) / next, static_cast<int>(order)),
      kShortestStep, kLongestStep);
}

/// Whether a spring exerts no force until its neighbours do: it is level, has exactly its rest length,
/// and both ends have the same vertical velocity and no horizontal one.
bool fallsFreely(const StateBuffer& state, Eigen::Index spring, double rest_length) {
  const auto z = state.values();
  const double width = z(spring + 1, 0) - z(spring, 0);
  const double square = width * width;
  return z(spring, 1) == z(spring + 1, 1) && z(spring, 2) == 0.0 && z(spring + 1, 2) == 0.0 &&
         z(spring, 3) == z(spring + 1, 3) && square * inverseSquareRoot(square) == rest_length;
}

/// Returns the particle at which the end that falls freely begins, at least 1.
/// \param size number of particles to examine: those beyond fall freely
Eigen::Index beginOfFreeFall(const StateBuffer& state, Eigen::Index size, double rest_length) {
  Eigen::Index first = size - 1;
  while (first > 1 && fallsFreely(state, first - 1, rest_length)) --first;
  return first;
}

}  // namespace

// The first omitted term of the velocities, |a_K| h^(K+1) / (K+1), may be `allowed_rate` times h. Its size is
// extrapolated from the last four coefficients. Even and odd coefficients are compared separately, because
// all odd ones vanish for an undamped chain released at rest. A symmetric scene can have a gap in either
// sequence, for example a_4 = a_7 = 0, which does not mean that the series converges fast.
double longestAccurateStep(const LastCoefficients& last, std::ptrdiff_t order,
                           double allowed_rate) {
  const auto& size = last.size;
  for (const double value : size)
    if (!std::isfinite(value)) return 0.0;
  const double squares[] = {squaredGrowth(size[0], size[2]), squaredGrowth(size[1], size[3])};
  const double square = std::max(squares[0], squares[1]);
  const double growth = square > 0.0 ? std::sqrt(square) : kUnknownGrowth;
  const double h = stepForGrowth(last, growth, order, allowed_rate);
  for (std::size_t i = 0; i < 2; ++i) {
    const bool vanishes = size[i] == 0.0 && size[i + 2] == 0.0;
    if (vanishes || squares[i] * h * h >= kLeastGrowthInStep * kLeastGrowthInStep) continue;
    return std::min(h, stepForGrowth(last, kUnknownGrowth, order, allowed_rate));
  }
  return h;
}

TaylorStepper::TaylorStepper(const Chain& chain, int order, double tolerance,
                             const ChainKernels& kernels)
    : chain_(chain),
      allowed_rate_(kErrorRate * tolerance *
                    std::max(1.0, fastestVibration(chain) / kSlowVibration)),
      kernels_(kernels),
      constants_(chain),
      expansion_(constants_.chain(), order),
      begin_(chain.size()),
      end_(chain.size()),
      inside_(chain.size()),
      carry_(chain.size()) {}

void TaylorStepper::start(const State& state) {
  for (StateBuffer* buffer : {&begin_, &end_, &inside_, &carry_}) buffer->setZero();
  end_.values() = state.values();
  expansion_.work.chain.size = chain_.size();
}

// The springs beyond the computed part fell freely in the last step and still do.
void TaylorStepper::skipFreeEnd() {
  if (!chain_.isPlain()) return;
  const Eigen::Index first =
      beginOfFreeFall(begin_, expansion_.work.chain.size, expansion_.work.chain.spring.rest_length);
  const Eigen::Index moving = StateBuffer::paddedSize(first + expansion_.work.order + 1);
  const Eigen::Index size = std::min<Eigen::Index>(chain_.size(), 1 + moving);
  // A store would delay the kernel, which loads the whole workspace at once.
  if (size != expansion_.work.chain.size) expansion_.work.chain.size = size;
}

double TaylorStepper::step() {
  std::swap(begin_, end_);
  skipFreeEnd();
  kernels_.taylorSeries(expansion_.work, begin_.data());
  statistics_.force_evaluations += expansion_.work.order;
  double h = longestAccurateStep(kernels_.lastCoefficients(expansion_.work), expansion_.work.order,
                                 allowed_rate_);
  if (h == 0.0) h = kShortestStep;  // near a collision, coefficients can overflow
  // When the ends of a spring meet, the series continues to negative lengths, but the motion does
  // not. So step close to that moment, then past it with the shortest step. Near it, the higher
  // coefficients are mostly rounding errors, so the shortest step uses only one.
  for (;; h = std::max(0.5 * h, kShortestStep)) {
    const bool shortest = h <= kShortestStep;
    terms_ = shortest ? 1 : expansion_.work.order;
    sumAt(h, begin_, end_);
    const auto middle = [&]() -> const StateBuffer& { return sumAt(0.5 * h, begin_, inside_); };
    if (shortest || !springsChangeMuch(kernels_, expansion_.work, h, begin_, end_, middle)) break;
  }
  if (h < kShortStep) {
    kernels_.compensatedSum(begin_.pitch(), begin_.data(), sumAt(h, carry_, inside_).data(),
                            kNoSlopes, end_.data(), carry_.data());
    if (!end_.values().allFinite()) return 0.0;
  }
  ++statistics_.accepted;
  statistics_.last_step = h;
  return h;
}

const StateBuffer& TaylorStepper::sumAt(double time, const StateBuffer& base,
                                        StateBuffer& out) const {
  kernels_.taylorState(expansion_.work, begin_.data(), base.data(), taylorWeights(terms_, time),
                       out.data());
  const Eigen::Index falling = chain_.size() - expansion_.work.chain.size;
  if (falling == 0) return out;
  // The arithmetic of the kernel for a free fall, where only the first coefficient is not zero. All
  // these particles fall at the same speed.
  const double drop = time * time / 2.0 * -chain_.gravity();
  const double speed = begin_.values().bottomRows(falling)(0, 3);
  const auto from = base.values().bottomRows(falling);
  auto to = out.values().bottomRows(falling);
  to.col(0) = from.col(0);
  to.col(1).array() = from.col(1).array() + fused(time, speed, drop);
  to.col(2) = from.col(2);
  to.col(3).array() = from.col(3).array() + time * -chain_.gravity();
  return out;
}

const StateBuffer& TaylorStepper::stateAt(double fraction) const {
  return fraction < 1.0 ? sumAt(fraction * statistics_.last_step, begin_, inside_) : end_;
}

}  // namespace spring_pendulum
