#include "sweep/study/random_numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace spring_pendulum::sweep {
namespace {

using Words = std::array<std::uint32_t, 4>;

// kat_vectors of Random123, the authors' own library.
TEST(Philox, HasTheKnownAnswers) {
  EXPECT_EQ(philox({}, {}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(philox({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

// Measured: 4.5e-16 and 1.2e-13.
TEST(PortableFunctions, AreAccurate) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> exponents(-690.0, 690.0);
  for (int i = 0; i < 10000; ++i) {
    const double x = exponents(generator), power = std::exp(x);
    EXPECT_NEAR(portableExp(x), power, 3e-13 * power) << x;
    EXPECT_NEAR(portableLog(power), x, 1e-15 * std::fmax(1.0, std::abs(x))) << x;
  }
  EXPECT_EQ(portableLog(1.0), 0.0);
  EXPECT_EQ(portableExp(0.0), 1.0);
}

TEST(RandomNumbers, DependOnSeedSampleParticleAndQuantity) {
  const auto first = [](std::uint64_t seed, std::uint64_t sample, std::uint32_t particle,
                        std::uint32_t quantity) {
    return RandomNumbers(seed, sample, particle, quantity).uniform();
  };
  const double number = first(1, 2, 3, 0);
  EXPECT_EQ(number, first(1, 2, 3, 0));
  EXPECT_NE(number, first(2, 2, 3, 0));
  EXPECT_NE(number, first(1, 3, 3, 0));
  EXPECT_NE(number, first(1, 2, 4, 0));
  EXPECT_NE(number, first(1, 2, 3, 1));
  EXPECT_NE(number, first(1 + (1ULL << 32U), 2, 3, 0));
  EXPECT_NE(number, first(1, 2 + (1ULL << 32U), 3, 0));
}

// Measured: mean 0.0006, variance 0.9989, fourth moment 2.99; uniform 0.0002 and 0.0832.
TEST(RandomNumbers, HaveTheirDistributions) {
  constexpr int kNumbers = 400'000;
  double sum = 0.0, squares = 0.0, fourths = 0.0, uniforms = 0.0, uniform_squares = 0.0;
  for (int i = 0; i < kNumbers; ++i) {
    RandomNumbers numbers(7, static_cast<std::uint64_t>(i), 1, 2);
    const double normal = numbers.normal();
    sum += normal;
    squares += normal * normal;
    fourths += normal * normal * normal * normal;
    const double uniform = numbers.uniform();
    EXPECT_TRUE(uniform > 0.0 && uniform < 1.0);
    uniforms += uniform - 0.5;
    uniform_squares += (uniform - 0.5) * (uniform - 0.5);
  }
  EXPECT_NEAR(sum / kNumbers, 0.0, 0.006);
  EXPECT_NEAR(squares / kNumbers, 1.0, 0.01);
  EXPECT_NEAR(fourths / kNumbers, 3.0, 0.06);
  EXPECT_NEAR(uniforms / kNumbers, 0.0, 0.002);
  EXPECT_NEAR(uniform_squares / kNumbers, 1.0 / 12.0, 0.0005);
}

}  // namespace
}  // namespace spring_pendulum::sweep
