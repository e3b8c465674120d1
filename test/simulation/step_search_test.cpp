#include "simulation/advice/step_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace spring_pendulum {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(LargestPassingStep, IsWithinTwoPercentBelowTheLimit) {
  for (const double limit : {2e-4, 0.0099, 0.0101, 0.3, 7.0}) {
    int tries = 0;
    const double step = largestPassingStep(0.01, 1e-5, 10.0, [&](double s) {
      ++tries;
      return s <= limit;
    });
    EXPECT_LE(step, limit);
    EXPECT_GT(1.02 * step, limit);
    EXPECT_LE(tries, 70) << limit;
  }
}

TEST(LargestPassingStep, LiesBelowAGapAndAboveNone) {
  // From 0.05 to 0.0525 s a step fails, and from 0.06 s on.
  const auto has_gap = [](double s) { return s < 0.06 && !(s > 0.05 && s < 0.0525); };
  const double step = largestPassingStep(0.01, 1e-5, 10.0, has_gap);
  EXPECT_GT(1.02 * step, 0.05);
  EXPECT_LE(step, 0.05);
  EXPECT_EQ(largestPassingStep(0.01, 1e-5, 10.0, [](double) { return false; }), 0.0);
  EXPECT_TRUE(std::isinf(largestPassingStep(0.01, 1e-5, 10.0, [](double) { return true; })));
  EXPECT_EQ(largestPassingStep(0.01, 2.0, 1.0, [](double) { return true; }), 0.0);
}

// 0.95 and 0.9 times the result are not on the grid.
TEST(LargestPassingStep, PassesAlsoWithTheUsualSafetyMargins) {
  std::set<double> tried;
  const double step = largestPassingStep(0.01, 1e-5, 10.0, [&](double s) {
    tried.insert(s);
    return s < 0.0777;
  });
  EXPECT_EQ(step, 0.0776);
  EXPECT_EQ(tried.count(0.95 * step) + tried.count(0.9 * step), 2U);
  const double lower = largestPassingStep(0.01, 1e-5, 10.0,
                                          [&](double s) { return s < 0.0777 && s != 0.95 * step; });
  EXPECT_LT(lower, step);
  EXPECT_GT(1.02 * lower, step);
}

TEST(LargestPassingStep, EndsForEveryRange) {
  for (const double first : {5e-324, 1e-300, 1.0, 1e308}) {
    for (const double least : {5e-324, 1e-310, 1.0, 1.7e308, kInfinity}) {
      for (const double most : {5e-324, 1.0, 1.7e308}) {
        for (const double limit : {0.0, 1e-310, 1.0, 1e300, kInfinity}) {
          const double step =
              largestPassingStep(first, least, most, [&](double s) { return s < limit; });
          EXPECT_TRUE(step == 0.0 || step == kInfinity || step < limit) << step;
        }
      }
    }
  }
}

// The worst a search can meet: steps that pass and fail at random.
TEST(LargestPassingStep, TriesFewStepsWhateverPasses) {
  for (unsigned seed = 1; seed < 50; ++seed) {
    unsigned random = seed;
    int tries = 0;
    largestPassingStep(0.01, 1e-7, 10.0, [&](double) {
      ++tries;
      random = random * 1664525U + 1013904223U;
      return (random >> 16U) % 10U != 0U;
    });
    EXPECT_LE(tries, 400);
  }
}

TEST(RoundedDown, KeepsThreeDigits) {
  EXPECT_EQ(roundedDown(0.012399), 0.0123);
  EXPECT_EQ(roundedDown(0.0123), 0.0123);
  EXPECT_EQ(roundedDown(5e-324), 5e-324);
}

}  // namespace
}  // namespace spring_pendulum
