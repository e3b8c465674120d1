#include "integration/taylor/stabilized_taylor_stepper.hpp"

#include "model/chain_modes.hpp"

#include <algorithm>
#include <limits>

namespace spring_pendulum {
namespace {

/// Used part of a stability interval. The rest is for the springs, which also add to the rates.
constexpr double kUsedStability = 0.97;

/// Step size in s below which the error is limited per time instead of per step. Such short steps
/// are taken where a light particle vibrates, and their many errors add up. Order 4 estimates its
/// errors so cautiously that it needs the limit at shorter steps only.
double leastTimePerError(int order) {
  return order == 4 ? 1e-3 : 5e-3;
}

/// Shorter steps, in s, are taken near a collision, not in a vibration. There, only a few count.
constexpr double kLeastVibration = 1e-6;

/// Time in s over which a velocity error counts as a position error: 1/rate of the fastest mode, at
/// most 1 s.
double timeOfVelocityError(const Chain& chain, double fastest_rate) {
  return 1.0 / std::max({fastest_rate, fastestVibration(chain), 1.0});
}

double longestStep(const StabilizedPolynomial& polynomial, double rate) {
  return kUsedStability * polynomial.real_stability_limit / rate;
}

/// Returns the weights of the plain series, with the term of degree j multiplied by kFactor(j).
template <auto kFactor>
TaylorWeights weighted(const StabilizedPolynomial& polynomial, double time) {
  TaylorWeights weights = taylorWeights(polynomial.terms, time);
  for (int n = 0; n < polynomial.terms; ++n) {
    weights.velocity[static_cast<std::size_t>(n)] *= (polynomial.*kFactor)(n + 1);
    weights.position[static_cast<std::size_t>(n)] *= (polynomial.*kFactor)(n + 2);
  }
  return weights;
}

TaylorWeights sumOf(const StabilizedPolynomial& polynomial, double time) {
  // Near a collision, which takes shortest steps, higher coefficients are mostly rounding errors.
  if (time <= kShortestStep) return taylorWeights(1, time);
  return weighted<&StabilizedPolynomial::weight>(polynomial, time);
}

}  // namespace

StabilizedTaylorStepper::StabilizedTaylorStepper(const Chain& chain, int order, double tolerance,
                                                 const ChainKernels& kernels)
    : ErrorEstimatingStepper(chain, kShareOfTolerance * tolerance, order, kernels),
      least_time_per_error_(leastTimePerError(order)),
      fastest_rate_(largestDampingRate(chain)),
      time_of_velocity_error_(timeOfVelocityError(chain, fastest_rate_)),
      polynomials_(stabilizedPolynomials(order)),
      polynomial_(polynomials_.begin()),
      expansion_(constants_.chain(), (polynomials_.end() - 1)->terms),
      change_(chain.size()),
      inside_(chain.size()) {}

void StabilizedTaylorStepper::prepare(bool /*restarted*/) {
  known_terms_ = 0;
}

double StabilizedTaylorStepper::admissible(double h) {
  polynomial_ = polynomials_.begin();
  if (fastest_rate_ == 0.0) return h;
  h = std::min(h, longestStep(*(polynomials_.end() - 1), fastest_rate_));
  while (longestStep(*polynomial_, fastest_rate_) < h) ++polynomial_;
  if (polynomial_ == polynomials_.begin()) return h;
  // A step at the limit of fewer terms may cover more time per term.
  const StabilizedPolynomial& fewer = *(polynomial_ - 1);
  const double shorter = longestStep(fewer, fastest_rate_);
  if (shorter * polynomial_->terms < h * fewer.terms) return h;
  polynomial_ = &fewer;
  return shorter;
}

double StabilizedTaylorStepper::attempt(double h) {
  TaylorWorkspace& work = expansion_.work;
  // A repeated step is shorter and needs no more terms.
  if (known_terms_ < polynomial_->terms) {
    known_terms_ = polynomial_->terms;
    work.order = known_terms_;
    kernels_.taylorSeries(work, begin_.data());
    statistics_.force_evaluations += known_terms_;
  }
  kernels_.taylorState(work, begin_.data(), carry_.data(), sumOf(*polynomial_, h), change_.data());
  setEnd(change_, kNoSlopes);
  // The series is invalid once the ends of a spring meet; see TaylorStepper::step.
  const auto middle = [&]() -> const StateBuffer& { return sumAt(0.5 * h); };
  if (h > kShortestStep && springsChangeMuch(kernels_, work, h, begin_, end_, middle))
    return std::numeric_limits<double>::infinity();
  const LargestChange error = kernels_.taylorLargestSum(
      work, weighted<&StabilizedPolynomial::errorWeight>(*polynomial_, h));
  return std::max(time_of_velocity_error_ * error.velocity, error.position) *
         std::max(1.0, least_time_per_error_ / std::max(h, kLeastVibration));
}

const StateBuffer& StabilizedTaylorStepper::sumAt(double time) const {
  kernels_.taylorState(expansion_.work, begin_.data(), begin_.data(), sumOf(*polynomial_, time),
                       inside_.data());
  return inside_;
}

}  // namespace spring_pendulum
