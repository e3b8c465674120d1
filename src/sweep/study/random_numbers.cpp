#include "sweep/study/random_numbers.hpp"

#include <cmath>

namespace spring_pendulum::sweep {
namespace {

constexpr int kRounds = 10;
constexpr double kLn2 = 0.69314718055994530942;
/// The series end below the rounding error for the reduced arguments, |s| <= 0.172 and |r| <= 0.347.
constexpr int kLogTerms = 11;
constexpr int kExpTerms = 15;
/// Quantity and number of the draw share a word of the counter.
constexpr std::uint32_t kQuantityShift = 24;

double toUniform(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (std::uint64_t{high} << 20U) ^ (low >> 12U);
  return (static_cast<double>(bits) + 0.5) * 0x1p-52;
}

}  // namespace

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> c,
                                    std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53} * c[0];
    const std::uint64_t b = std::uint64_t{0xCD9E8D57} * c[2];
    c = {static_cast<std::uint32_t>(b >> 32U) ^ c[1] ^ key[0], static_cast<std::uint32_t>(b),
         static_cast<std::uint32_t>(a >> 32U) ^ c[3] ^ key[1], static_cast<std::uint32_t>(a)};
    key = {key[0] + 0x9E3779B9U, key[1] + 0xBB67AE85U};
  }
  return c;
}

double portableLog(double x) {
  int exponent = 0;
  double fraction = std::frexp(x, &exponent);  // from 0.5 to 1
  if (fraction < 0.70710678118654752) {
    fraction *= 2.0;
    --exponent;
  }
  const double s = (fraction - 1.0) / (fraction + 1.0);
  double sum = 0.0;  // of s^(2k) / (2k + 1)
  for (int k = kLogTerms; k >= 0; --k) sum = sum * s * s + 1.0 / (2 * k + 1);
  return exponent * kLn2 + 2.0 * s * sum;
}

double portableExp(double x) {
  const double exponent = std::nearbyint(x / kLn2);
  const double r = x - exponent * kLn2;
  double sum = 1.0;
  for (int k = kExpTerms; k > 0; --k) sum = 1.0 + sum * r / k;
  return std::ldexp(sum, static_cast<int>(exponent));
}

RandomNumbers::RandomNumbers(std::uint64_t seed, std::uint64_t sample, std::uint32_t particle,
                             std::uint32_t quantity)
    : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U)},
      counter_{quantity << kQuantityShift, particle, static_cast<std::uint32_t>(sample),
               static_cast<std::uint32_t>(sample >> 32U)} {}

double RandomNumbers::uniform() {
  if (left_ == 0) {
    const std::array<std::uint32_t, 4> bits = philox(counter_, key_);
    ++counter_[0];
    numbers_ = {toUniform(bits[2], bits[3]), toUniform(bits[0], bits[1])};
    left_ = 2;
  }
  return numbers_[static_cast<std::size_t>(--left_)];
}

double RandomNumbers::normal() {
  for (;;) {
    const double x = 2.0 * uniform() - 1.0;
    const double y = 2.0 * uniform() - 1.0;
    const double square = x * x + y * y;
    if (square < 1.0 && square > 0.0) return x * std::sqrt(-2.0 * portableLog(square) / square);
  }
}

}  // namespace spring_pendulum::sweep
