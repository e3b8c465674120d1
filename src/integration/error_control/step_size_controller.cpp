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

constexpr double kSmallest = 1e-300;  ///< smaller numbers are not normalised
constexpr int kMantissaBits = 52;
constexpr int kExponentBias = 1023;
constexpr std::int64_t kMantissa = (std::int64_t{1} << kMantissaBits) - 1;
constexpr std::int64_t kOneBits = std::int64_t{kExponentBias} << kMantissaBits;  ///< bits of 1.0

template <typename To, typename From>
To withBitsOf(From from) {
  To to{};
  std::memcpy(&to, &from, sizeof(to));
  return to;
}

/// Returns log2(1 + f) for f in [0, 1], exact at both ends; error at most 1.6e-5 (the polynomial
/// with the least maximum error).
double binaryLogarithm(double f) {
  const double low = 0.44191704 - 0.26717942 * f;
  const double high = 0.14842667 - 0.04514906 * f;
  return f + f * (1.0 - f) * (low + f * f * high);
}

/// Returns 2^f for f in [0, 1], exact at both ends; error at most 4.8e-6 (as above).
double powerOfTwo(double f) {
  const double low = 0.30699608 + 0.06544626 * f;
  return 1.0 + (f - f * (1.0 - f) * (low + 0.013702 * (f * f)));
}

}  // namespace

double root(double x, int k) {
  if (!(x > 0.0)) return 0.0;
  const auto bits = withBitsOf<std::int64_t>(std::max(x, kSmallest));
  const auto mantissa = withBitsOf<double>((bits & kMantissa) | kOneBits);
  const double logarithm = static_cast<double>((bits >> kMantissaBits) - kExponentBias) +
                           binaryLogarithm(mantissa - 1.0);
  const double biased = logarithm * (1.0 / k) + kExponentBias;
  const auto whole = static_cast<std::int64_t>(biased);
  return withBitsOf<double>(whole << kMantissaBits) *
         powerOfTwo(biased - static_cast<double>(whole));
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
