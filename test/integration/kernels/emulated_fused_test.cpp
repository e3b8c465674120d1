#include "integration/kernels/instruction_sets/emulated_fused.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

namespace spring_pendulum {
namespace {

std::uint64_t bitsOf(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return std::isnan(value) ? 0 : bits;
}

void expectFused(double a, double b, double c) {
  const TwoLanes found = emulatedFused(TwoLanes{a, c}, TwoLanes{b, b}, TwoLanes{c, a});
  EXPECT_EQ(bitsOf(found[0]), bitsOf(std::fma(a, b, c))) << a << " * " << b << " + " << c;
  EXPECT_EQ(bitsOf(found[1]), bitsOf(std::fma(c, b, a))) << c << " * " << b << " + " << a;
}

TEST(EmulatedFused, RoundsOnceForOrdinaryNumbers) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> number(-2.0, 2.0);
  std::uniform_int_distribution<int> exponent(-120, 120);
  int twice_rounded = 0;
  for (int k = 0; k < 300000; ++k) {
    const double a = number(random), b = number(random);
    const double c = std::ldexp(number(random), exponent(random));
    expectFused(a, b, c);
    expectFused(a, b, -a * b);  // leaves the product's error
    const double near_tie = std::ldexp(std::ldexp(a * b, -53), exponent(random) % 3);
    expectFused(a, b, near_tie);
    if (a * b + c != std::fma(a, b, c)) ++twice_rounded;
  }
  EXPECT_GT(twice_rounded, 1000);
}

// Sums that lie a tiny bit beside the middle of two numbers.
TEST(EmulatedFused, RoundsOnceNextToTies) {
  for (int shift = 50; shift < 56; ++shift)
    for (const double tiny : {0.0, 0x1p-104, -0x1p-104, 0x1p-60, -0x1p-60})
      for (const double sign : {1.0, -1.0}) {
        const double half = std::ldexp(1.0, -shift);
        expectFused(1.0 + half, 1.0 + tiny, sign);
        expectFused(1.0 + 0x1p-52, 1.0 - 0x1p-53, sign * half);
        expectFused(sign * (half + tiny), 1.0 + 0x1p-52, 1.0);
        expectFused(sign * half, 1.0 + tiny, 3.0 + 0x1p-51);
      }
}

TEST(EmulatedFused, HandlesZerosInfinitiesAndTheLimitsOfTheRange) {
  const double inf = std::numeric_limits<double>::infinity();
  const double values[] = {0.0,   -0.0,         1.0,     -3.0,     1e-160,    -1e-200,
                           1e155, -1e300,       1.7e308, 5e-324,   -2.2e-308, inf,
                           -inf,  std::nan(""), 0x1p500, 0x1p-450, 0x1p999,   0x1.8p-900};
  for (const double a : values)
    for (const double b : values)
      for (const double c : values) expectFused(a, b, c);
}

TEST(EmulatedFused, RoundsOnceForAnyBits) {
  std::mt19937_64 random(12);
  const auto any = [&random] {
    const std::uint64_t bits = random();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  };
  for (int k = 0; k < 300000; ++k) expectFused(any(), any(), any());
}

}  // namespace
}  // namespace spring_pendulum
