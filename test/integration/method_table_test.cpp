#include "integration/tableau.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <string>

#include "support/reference.hpp"

namespace spring_pendulum {
namespace {

TEST(MethodTable, EveryNameFindsItsOwnRowAndMakesAnIntegrator) {
  const Chain chain(Eigen::VectorXd::Ones(3), SpringLaw{}, 9.81);
  for (const Method& method : methodTable()) {
    EXPECT_EQ(findMethod(method.name).name, method.name);
    EXPECT_NE(makeIntegrator(method, chain), nullptr) << method.name;
  }
}

/// |R(z)| of an embedded pair or a Taylor series.
double amplification(const Method& method, std::complex<double> z) {
  if (method.tableau != nullptr) return std::abs(1.0 + stabilityIncrement(*method.tableau, z));
  std::complex<double> sum = 1.0, term = 1.0;
  for (int n = 1; n <= method.order; ++n) sum += term *= z / static_cast<double>(n);
  return std::abs(sum);
}

TEST(MethodTable, HasTheStabilityLimitsOfTheErrorControlledMethods) {
  const std::complex<double> i(0.0, 1.0);
  for (const char* name : {"Dormand-Prince-5", "Taylor-8", "Taylor-12"}) {
    const Method& method = findMethod(name);
    const double real = method.real_stability_limit, imaginary = method.imaginary_stability_limit;
    for (int k = 1; k <= 1000; ++k) {
      EXPECT_LE(amplification(method, -0.001 * k * real), 1.0 + 1e-8) << name;
      EXPECT_LE(amplification(method, 0.001 * k * imaginary * i), 1.0 + 1e-8) << name;
    }
    EXPECT_GT(amplification(method, -1.001 * real), 1.0 + 1e-5) << name;
    EXPECT_GT(amplification(method, 1.01 * imaginary * i), 1.0 + 1e-8) << name;
  }
}

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

TEST(MethodOfTableau, FindsOrderAndLimitsOfTheBuiltInMethods) {
  int methods = 0;
  for (const Method& method : methodTable()) {
    if (method.tableau == nullptr || !method.hasFixedStep()) continue;
    const Method found = methodOfTableau("own", *method.tableau);
    EXPECT_EQ(found.order, method.order) << method.name;
    EXPECT_EQ(found.stages, method.stages) << method.name;
    // Measured: at most 1.2e-12.
    EXPECT_NEAR(found.real_stability_limit, method.real_stability_limit, 1e-10) << method.name;
    EXPECT_NEAR(found.imaginary_stability_limit, method.imaginary_stability_limit, 1e-10)
        << method.name;
    ++methods;
  }
  EXPECT_GE(methods, 3);
}

TEST(MethodOfTableau, FindsThirdOrder) {
  const ButcherTableau kutta{3, {{{}, {0.5}, {-1.0, 2.0}}}, {1.0 / 6, 2.0 / 3, 1.0 / 6}};
  const Method method = methodOfTableau("Kutta-3", kutta);
  EXPECT_EQ(method.order, 3);
  EXPECT_NEAR(method.real_stability_limit, 2.512745, 1e-6);
  EXPECT_NEAR(method.imaginary_stability_limit, std::sqrt(3.0), 1e-6);
}

TEST(SmallestTolerance, GrowsWithTheCoordinates) {
  const Chain chain(Eigen::VectorXd::Ones(2), SpringLaw{}, 9.81);
  State state(2);
  state.x() << 0.0, 1.0;
  EXPECT_NEAR(smallestTolerance(chain, state), 2.2e-13, 0.2e-13);
  state.x() << 1e12, 1e12 + 1.0;
  EXPECT_NEAR(smallestTolerance(chain, state), 0.022, 0.002);
}

// A tolerance at this limit is met.
TEST(SmallestTolerance, IsReached) {
  test::Scene scene = test::referenceScene("two_masses_45deg");
  const double tolerance = smallestTolerance(scene.chain, scene.start);
  for (const char* method : {"Taylor-12", "Radau-9", "Auto"}) {
    State state = scene.start;
    makeIntegrator(method, scene.chain, {tolerance})->advance(state, 1.0, 1);
    EXPECT_LT(test::positionError(state, test::referenceSolution("two_masses_45deg", 1)),
              10.0 * tolerance)
        << method;
  }
}

// Impossible tolerances cost time, but runs end.
TEST(SmallestTolerance, BelowItEveryMethodEnds) {
  const Chain chain(Eigen::VectorXd::Ones(2), SpringLaw{}, 9.81);
  for (const Method& method : methodTable())
    for (const double tolerance : {1e-18, 1e-300}) {
      State state(2);
      state.x()[1] = 1.0;
      const auto integrator = makeIntegrator(method, chain, {tolerance});
      integrator->advance(state, 1e-7, 10);
      EXPECT_LT(integrator->forceEvaluations(), 1000000) << method.name << " at " << tolerance;
    }
}

/// Two particles, a metre apart.
std::string messageFor(double tolerance, double place) {
  State state(2);
  state.x() << place, place + 1.0;
  try {
    checkTolerance(tolerance, Chain(Eigen::VectorXd::Ones(2), SpringLaw{}, 9.81), state);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SmallestTolerance, IsNamedByTheCheck) {
  EXPECT_EQ(messageFor(1e-12, 0.0), "");
  EXPECT_THAT(messageFor(1e-300, 0.0), testing::StartsWith("tolerance: must be at least 2.3e-13"));
  EXPECT_EQ(messageFor(2.3e-13, 0.0), "");
  EXPECT_THAT(messageFor(1e-6, 1e12), testing::StartsWith("tolerance: must be at least 2.3e-02 m"));
  EXPECT_EQ(messageFor(2.3e-2, 1e12), "");
  EXPECT_THAT(messageFor(1e-6, HUGE_VAL), testing::StartsWith("rest_length, positions or veloc"));
}

}  // namespace
}  // namespace spring_pendulum
