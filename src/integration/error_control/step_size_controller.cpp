#include "integration/error_control/step_size_controller.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace spring_pendulum {
namespace {

constexpr double kSafety = 0.9;
constexpr double kLargestGrowth = 5.0;
constexpr double kLargestCut = 0.2;
constexpr double kSmallestRoot = 0.05;  ///< errors below this ^k grow the step no further

constexpr int kMostNewtonSteps = 40;

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
  // The bits of a double, read as an integer, are nearly its logarithm: dividing their distance
  // from those of 1 by k gives the root to a few percent.
  constexpr std::int64_t kOne = 0x3ff0000000000000;
  std::int64_t bits = 0;
  std::memcpy(&bits, &x, sizeof(bits));
  bits = kOne + (bits - kOne) / k;
  double y = 0.0;
  std::memcpy(&y, &bits, sizeof(y));
  for (int i = 0; i < kMostNewtonSteps; ++i) {
    const double change = (y - x / integerPower(y, k - 1)) / k;
    y -= change;
    if (std::abs(change) < 1e-5 * y) break;
  }
  return y;
}

double StepSizeController::next(double h, double error) {
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
