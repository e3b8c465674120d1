#include "integration/tableau.hpp"

#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

namespace spring_pendulum {
namespace {

TEST(RootedTrees, AreAsManyAsCayleyCounted) {
  EXPECT_EQ(rootedTrees(1).size(), 1U);
  EXPECT_EQ(rootedTrees(4).size(), 1U + 1U + 2U + 4U);
  EXPECT_EQ(rootedTrees(8).size(), 1U + 1U + 2U + 4U + 9U + 20U + 48U + 115U);
}

TEST(OrderConditions, EveryTableauHasItsOrderAndNoMore) {
  for (const Method& method : methodTable()) {
    if (method.tableau == nullptr) continue;
    const ButcherTableau& tableau = *method.tableau;
    // Measured: at most 1.1e-16.
    EXPECT_LT(orderConditionResidual(tableau, tableau.b, method.order), 1e-14) << method.name;
    EXPECT_GT(orderConditionResidual(tableau, tableau.b, method.order + 1), 1e-8) << method.name;
  }
}

TEST(OrderConditions, OneAlteredCoefficientIsFound) {
  for (const Method& method : methodTable()) {
    if (method.tableau == nullptr) continue;
    ButcherTableau altered = *method.tableau;
    if (altered.stages > 1) {
      altered.a[altered.stages - 1][0] += 1e-6;
      // Measured: at least 1.6e-7 with Runge-Kutta-4.
      EXPECT_GT(orderConditionResidual(altered, altered.b, method.order), 1e-9) << method.name;
    }
    altered = *method.tableau;
    altered.b[0] += 1e-6;
    EXPECT_GT(orderConditionResidual(altered, altered.b, method.order), 1e-7) << method.name;
  }
}

}  // namespace
}  // namespace spring_pendulum
