#include "simulation/mode_response.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>

namespace spring_pendulum {
namespace {

using Complex = std::complex<double>;

/// Stability function of a tableau at z = hλ.
Complex stabilityFunction(const ButcherTableau& tableau, Complex z) {
  std::array<Complex, ButcherTableau::kMaxStages> stage{};
  Complex result = 1.0;
  for (std::size_t i = 0; i < tableau.stages; ++i) {
    stage[i] = 1.0;
    for (std::size_t j = 0; j < i; ++j) stage[i] += z * tableau.a[i][j] * stage[j];
    result += z * tableau.b[i] * stage[i];
  }
  return result;
}

/// The two roots of λ² + d λ + k with the faster one on the unit circle.
std::pair<Complex, Complex> roots(double damping_ratio) {
  const Complex root = std::sqrt(Complex(damping_ratio * damping_ratio - 1.0));
  const Complex fast = -damping_ratio - root;
  return {fast / std::abs(fast), (-damping_ratio + root) / std::abs(fast)};
}

TEST(ModeResponse, IsTheStabilityFunctionOfATableau) {
  for (const Method& method : methodTable()) {
    if (method.tableau == nullptr || method.control != StepControl::kFixed) continue;
    for (const double ratio : {0.0, 0.1, 0.7, 1.5, 20.0}) {
      const ModeResponse response(method, ratio);
      for (const double s : {0.1, 1.0, 2.5, 4.0}) {
        const auto [fast, slow] = roots(ratio);
        const Complex expected_fast = stabilityFunction(*method.tableau, s * fast);
        const Complex expected_slow = stabilityFunction(*method.tableau, s * slow);
        const Eigen::Matrix2d matrix = response.matrix(s);
        // Errors of rounding over a displacement of 2^-10.
        EXPECT_NEAR(matrix.trace(), (expected_fast + expected_slow).real(), 1e-9) << method.name;
        EXPECT_NEAR(matrix.determinant(), (expected_fast * expected_slow).real(), 1e-8);
        const double radius = std::max(std::abs(expected_fast), std::abs(expected_slow));
        const double rate = std::max(2.0 * std::log(radius) / s, 0.0);
        EXPECT_NEAR(response.growthRate(s), rate, 1e-9) << method.name << " " << ratio << " " << s;
      }
    }
  }
}

TEST(ModeResponse, ADashpotAloneDecaysAlongTheRealAxis) {
  const Method& method = findMethod("Runge-Kutta-4");
  const ModeResponse response(method, std::numeric_limits<double>::infinity());
  EXPECT_EQ(response.growthRate(0.999 * method.real_stability_limit), 0.0);
  EXPECT_GT(response.growthRate(1.001 * method.real_stability_limit), 0.0);
}

TEST(ModeResponse, LimitsOfTheTableLieOnTheBorder) {
  for (const Method& method : methodTable()) {
    if (method.control != StepControl::kFixed) continue;
    const ModeResponse undamped(method, 0.0);
    if (std::isfinite(method.imaginary_stability_limit) && method.imaginary_stability_limit > 0.0) {
      EXPECT_EQ(undamped.growthRate(0.99 * method.imaginary_stability_limit), 0.0) << method.name;
      EXPECT_GT(undamped.growthRate(1.01 * method.imaginary_stability_limit), 0.0) << method.name;
    } else if (method.imaginary_stability_limit == 0.0) {
      EXPECT_GT(undamped.growthRate(0.1), 0.0) << method.name;
    }
    if (!std::isfinite(method.real_stability_limit)) continue;
    const ModeResponse damped(method, std::numeric_limits<double>::infinity());
    EXPECT_EQ(damped.growthRate(0.99 * method.real_stability_limit), 0.0) << method.name;
    EXPECT_GT(damped.growthRate(1.01 * method.real_stability_limit), 0.0) << method.name;
  }
}

TEST(ModeResponse, StableStepsMayGainEnergyBeforeTheyLoseIt) {
  // At 45 degrees from the real axis, close to the border: every power shrinks in the end.
  const ModeResponse response(findMethod("Runge-Kutta-4"), std::sqrt(0.5));
  EXPECT_EQ(response.growthRate(2.7), 0.0);
  EXPECT_GT(response.largestGain(2.7), 1.1);
  EXPECT_EQ(response.largestGain(0.5), 1.0);
}

TEST(ModeResponse, RootsOfAMode) {
  EXPECT_DOUBLE_EQ(fasterRoot({50.0, 0.0, 1.0}, 2.0), 10.0);
  EXPECT_DOUBLE_EQ(fasterRoot({0.0, 3.0, 1.0}, 2.0), 6.0);
  EXPECT_DOUBLE_EQ(fasterRoot({9.0, 10.0, 1.0}, 1.0), 9.0);  // λ² + 10 λ + 9
  EXPECT_DOUBLE_EQ(dampingRatio({9.0, 10.0, 1.0}, 1.0), 5.0 / 3.0);
}

}  // namespace
}  // namespace spring_pendulum
