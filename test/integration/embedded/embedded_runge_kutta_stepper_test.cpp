#include "integration/embedded/embedded_runge_kutta_stepper.hpp"

#include "integration/tableau.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

namespace spring_pendulum {
namespace {

struct PairCase {
  const char* method;
  const EmbeddedPair* pair;
  int embedded_order;
  int dense_order;
};

const PairCase kCases[] = {{"Dormand-Prince-5", &kDormandPrince5, 4, 4}};

/// All slopes of the pair as one tableau, so that weights may use every one of them.
ButcherTableau allSlopes(const EmbeddedPair& pair) {
  ButcherTableau tableau = pair.tableau;
  tableau.a[pair.tableau.stages] = pair.tableau.b;
  tableau.stages = pair.dense_slopes;
  return tableau;
}

EmbeddedPair::Weights difference(const EmbeddedPair::Weights& a, const EmbeddedPair::Weights& b) {
  EmbeddedPair::Weights result{};
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = a[i] - b[i];
  return result;
}

TEST(EmbeddedPair, ErrorsBelongToMethodsOfLowerOrder) {
  for (const PairCase& c : kCases) {
    const ButcherTableau slopes = allSlopes(*c.pair);
    const auto embedded = difference(c.pair->tableau.b, c.pair->error);
    // Measured: at most 5e-15, and at least 4.5e-4 an order higher.
    EXPECT_LT(orderConditionResidual(slopes, embedded, c.embedded_order), 1e-14) << c.method;
    EXPECT_GT(orderConditionResidual(slopes, embedded, c.embedded_order + 1), 1e-5) << c.method;
  }
}

/// The largest violation of a condition up to `order` by the state at θ: b_i(θ)/θ are the weights
/// of a method with the tableau a/θ.
double denseResidual(const EmbeddedPair& pair, double theta, int order) {
  ButcherTableau scaled = allSlopes(pair);
  for (auto& row : scaled.a) {
    for (double& entry : row) entry /= theta;
  }
  EmbeddedPair::Weights weights = pair.denseWeights(theta);
  for (double& weight : weights) weight /= theta;
  return orderConditionResidual(scaled, weights, order);
}

TEST(EmbeddedPair, DenseOutputHasItsOrderInTheWholeStep) {
  for (const PairCase& c : kCases) {
    for (const double theta : {0.3, 0.5, 0.8}) {
      // Measured: at most 8e-13, and at least 6.7e-4 an order higher.
      EXPECT_LT(denseResidual(*c.pair, theta, c.dense_order), 1e-11) << c.method << " " << theta;
      EXPECT_GT(denseResidual(*c.pair, theta, c.dense_order + 1), 1e-5) << c.method << " " << theta;
    }
    const auto gap = difference(c.pair->denseWeights(1.0), c.pair->tableau.b);
    for (const double weight : gap) EXPECT_NEAR(weight, 0.0, 1e-12) << c.method;
    for (const double weight : c.pair->denseWeights(0.0)) EXPECT_EQ(weight, 0.0) << c.method;
  }
}

TEST(EmbeddedPair, OneAlteredCoefficientIsFound) {
  for (const PairCase& c : kCases) {
    EmbeddedPair altered = *c.pair;
    altered.error[0] += 1e-6;
    EXPECT_GT(
        orderConditionResidual(allSlopes(altered), difference(altered.tableau.b, altered.error),
                               c.embedded_order),
        1e-7)
        << c.method;
    altered = *c.pair;
    altered.dense[c.pair->dense_slopes - 1][1] += 1e-6;
    EXPECT_GT(denseResidual(altered, 0.5, c.dense_order), 1e-8) << c.method;
  }
}

// |R(z)| of z' = λz with z = hλ.
double amplification(const ButcherTableau& tableau, std::complex<double> z) {
  std::array<std::complex<double>, ButcherTableau::kMaxStages> slope{};
  std::complex<double> end = 1.0;
  for (std::size_t i = 0; i < tableau.stages; ++i) {
    std::complex<double> stage = 1.0;
    for (std::size_t j = 0; j < i; ++j) stage += z * tableau.a[i][j] * slope[j];
    slope[i] = stage;
    end += z * tableau.b[i] * stage;
  }
  return std::abs(end);
}

TEST(EmbeddedPair, StabilityLimitsAreThoseOfTheTable) {
  const std::complex<double> i(0.0, 1.0);
  for (const PairCase& c : kCases) {
    const Method& method = findMethod(c.method);
    const ButcherTableau& tableau = c.pair->tableau;
    for (int k = 1; k <= 1000; ++k) {
      const double part = 0.001 * k;
      EXPECT_LE(amplification(tableau, -part * method.real_stability_limit), 1.0 + 1e-8);
      EXPECT_LE(amplification(tableau, part * method.imaginary_stability_limit * i), 1.0 + 1e-8);
    }
    EXPECT_GT(amplification(tableau, -1.001 * method.real_stability_limit), 1.0 + 1e-5) << c.method;
    EXPECT_GT(amplification(tableau, 1.01 * method.imaginary_stability_limit * i), 1.0 + 1e-8)
        << c.method;
  }
}

}  // namespace
}  // namespace spring_pendulum
