#include "integration/embedded/embedded_runge_kutta_stepper.hpp"

#include "integration/tableau.hpp"

#include <gtest/gtest.h>

#include <cstddef>

namespace spring_pendulum {
namespace {

constexpr int kEmbeddedOrder = 4;
constexpr int kDenseOrder = 4;

/// All slopes of the pair as one tableau, so that weights may use every one of them.
ButcherTableau allSlopes(const EmbeddedPair& pair) {
  ButcherTableau tableau = pair.tableau;
  tableau.a[pair.tableau.stages] = pair.tableau.b;
  ++tableau.stages;
  return tableau;
}

EmbeddedPair::Weights difference(const EmbeddedPair::Weights& a, const EmbeddedPair::Weights& b) {
  EmbeddedPair::Weights result{};
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = a[i] - b[i];
  return result;
}

TEST(EmbeddedPair, ErrorBelongsToAMethodOfLowerOrder) {
  const ButcherTableau slopes = allSlopes(kDormandPrince5);
  const auto embedded = difference(kDormandPrince5.tableau.b, kDormandPrince5.error);
  // Measured: at most 5e-15, and at least 4.5e-4 an order higher.
  EXPECT_LT(orderConditionResidual(slopes, embedded, kEmbeddedOrder), 1e-14);
  EXPECT_GT(orderConditionResidual(slopes, embedded, kEmbeddedOrder + 1), 1e-5);
}

/// The largest violation of a condition up to `order` at θ: b_i(θ)/θ are the weights of the tableau a/θ.
double denseResidual(const EmbeddedPair& pair, double theta, int order) {
  ButcherTableau scaled = allSlopes(pair);
  for (auto& row : scaled.a)
    for (double& entry : row) entry /= theta;
  EmbeddedPair::Weights weights = pair.denseWeights(theta);
  for (double& weight : weights) weight /= theta;
  return orderConditionResidual(scaled, weights, order);
}

TEST(EmbeddedPair, DenseOutputHasItsOrderInTheWholeStep) {
  for (const double theta : {0.3, 0.5, 0.8}) {
    // Measured: at most 8e-13, and at least 6.7e-4 an order higher.
    EXPECT_LT(denseResidual(kDormandPrince5, theta, kDenseOrder), 1e-11) << theta;
    EXPECT_GT(denseResidual(kDormandPrince5, theta, kDenseOrder + 1), 1e-5) << theta;
  }
  const auto gap = difference(kDormandPrince5.denseWeights(1.0), kDormandPrince5.tableau.b);
  for (const double weight : gap) EXPECT_NEAR(weight, 0.0, 1e-12);
  for (const double weight : kDormandPrince5.denseWeights(0.0)) EXPECT_EQ(weight, 0.0);
}

TEST(EmbeddedPair, OneAlteredCoefficientIsFound) {
  EmbeddedPair altered = kDormandPrince5;
  altered.error[0] += 1e-6;
  EXPECT_GT(orderConditionResidual(allSlopes(altered), difference(altered.tableau.b, altered.error),
                                   kEmbeddedOrder),
            1e-7);
  altered = kDormandPrince5;
  altered.dense[altered.tableau.stages][1] += 1e-6;
  EXPECT_GT(denseResidual(altered, 0.5, kDenseOrder), 1e-8);
}

}  // namespace
}  // namespace spring_pendulum
