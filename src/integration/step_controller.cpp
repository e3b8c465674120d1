#include <spring_pendulum/integration/step_controller.hpp>

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

constexpr double kSafety = 0.9;
constexpr double kLargestGrowth = 5.0;
constexpr double kLargestCut = 0.2;
constexpr double kSmallestRoot = 0.05;  ///< errors below this ^k grow the step no further

double integerPower(double x, int n) {
  double power = 1.0;
  for (; n > 0; n /= 2, x *= x) {
    if (n % 2 == 1) power *= x;
  }
  return power;
}

}  // namespace

double root(double x, int k) {
  if (!(x > 0.0)) return 0.0;
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);  // x = fraction * 2^exponent, exactly
  int whole = exponent / k;
  if (exponent - whole * k > 0) ++whole;
  // The root of the scaled number lies in (2^-(1 + 1/k), 1]; Newton from above falls to it
  // monotonically, in the worst case (k large) by a factor 1 - 1/k a time at first.
  const double scaled = std::ldexp(fraction, exponent - whole * k);
  double y = 1.0;
  for (int i = 0; i < 40; ++i) {
    const double next = y - (y - scaled / integerPower(y, k - 1)) / k;
    if (next >= y) break;  // rounding has the last word
    y = next;
  }
  return std::ldexp(y, whole);
}

double StepController::next(double h, double error) {
  const double e = error < 1e30 ? error : 1e30;  // catches NaN too
  const double r = std::clamp(root(e, error_order_), kSmallestRoot, 1e3);
  if (!accepts(e)) {
    after_rejection_ = true;
    return h * std::max(kSafety / r, kLargestCut);
  }
  const double eighth = std::sqrt(std::sqrt(std::sqrt(r)));
  const double quarter = std::sqrt(std::sqrt(previous_root_));
  const double factor = std::clamp(kSafety * quarter * eighth / r, kLargestCut, kLargestGrowth);
  previous_root_ = r;
  const bool hold = after_rejection_;
  after_rejection_ = false;
  return h * (hold ? std::min(factor, 1.0) : factor);
}

}  // namespace spring_pendulum
