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
constexpr double kSmallestRoot = 0.05;  ///< smaller roots do not increase the step size further

constexpr std::int64_t kOneBits = 0x3ff0000000000000;  ///< bits of 1.0
constexpr double kSmallest = 1e-300;                   ///< smaller x would make 1/x overflow
/// Mean error of the logarithm that the bits of a double represent; see `root`.
constexpr std::int64_t kMeanExcess = 0x0000b00000000000;

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
  x = std::max(x, kSmallest);
  // The bits of a double, read as an integer, are nearly a linear function of its logarithm.
  // Dividing their difference from the bits of 1 by -k therefore gives the inverse 1/y of the root
  // y to about 3 %. Newton's method for x (1/y)^k = 1 improves it without divisions.
  std::int64_t bits = 0;
  std::memcpy(&bits, &x, sizeof(bits));
  bits = kOneBits - (bits - kOneBits) / k - kMeanExcess;
  double inverse = 0.0;
  std::memcpy(&inverse, &bits, sizeof(inverse));
  const double share = 1.0 / k;
  const int steps = k <= 12 ? 4 : 6;  // the error e becomes (k + 1) e^2 / 2
  for (int i = 0; i < steps; ++i) {
    inverse += inverse * share * (1.0 - x * integerPower(inverse, k));
  }
  return x * integerPower(inverse, k - 1);
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
