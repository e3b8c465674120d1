#include "integration/taylor/stabilized_taylor_stepper.hpp"

#include "integration/error_control/dense_output_integrator.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <memory>
#include <string>

#include <support/reference.hpp>

namespace spring_pendulum {
namespace {

template <typename Weight>
std::complex<double> polynomial(int terms, const Weight& weight, std::complex<double> z) {
  std::complex<double> sum = 0.0;
  std::complex<double> power = 1.0;
  for (int j = 0; j <= terms; ++j) {
    sum += weight(j) * power;
    power *= z / (j + 1.0);
  }
  return sum;
}

double growth(const StabilizedPolynomial& p, std::complex<double> z) {
  return std::abs(polynomial(
      p.terms, [&p](int term) { return p.weight(term); }, z));
}

double estimatedError(const StabilizedPolynomial& p, std::complex<double> z) {
  return std::abs(polynomial(
      p.terms, [&p](int term) { return p.errorWeight(term); }, z));
}

const Method& rowOf(int order) {
  return findMethod("Stabilized-Taylor-" + std::to_string(order));
}

TEST(StabilizedPolynomials, AreStableAsFarAsTheTableSaysAndNotMuchFurther) {
  for (const int order : {4, 8})
    for (const StabilizedPolynomial& p : stabilizedPolynomials(order)) {
      const double limit = p.real_stability_limit;
      for (double x = 0.01; x < limit; x += 0.01)
        ASSERT_LT(growth(p, -x), x < 0.3 || p.terms == order ? 1.0 : 0.951) << p.terms << " " << x;
      EXPECT_GT(growth(p, -1.01 * limit), p.terms == order ? 1.0 : 0.95) << p.terms;
      for (double y = 0.05; y < rowOf(order).imaginary_stability_limit; y += 0.05)
        ASSERT_LT(growth(p, {0.0, y}), 1.0 + 1e-14) << p.terms << " " << y;
    }
}

// The estimate is of order p - 1, and no fast mode of amplitude 1 shows in it as more than that.
TEST(StabilizedPolynomials, ErrorEstimatesKeepClearOfFastModes) {
  for (const int order : {4, 8}) {
    const double first = stabilizedPolynomials(order).begin()->errorWeight(order);
    for (const StabilizedPolynomial& p : stabilizedPolynomials(order)) {
      EXPECT_EQ(p.errorWeight(order - 1), 0.0);
      EXPECT_EQ(p.errorWeight(order), first) << p.terms;
      for (double x = 0.0; x < p.real_stability_limit; x += 0.01)
        ASSERT_LT(estimatedError(p, -x), 1.2) << p.terms << " " << x;  // 1.10
    }
  }
}

TEST(StabilizedTaylorStepper, TableOfMethodsStatesTheLargestLimitAndTheLeastTerms) {
  for (const int order : {4, 8}) {
    const auto all = stabilizedPolynomials(order);
    EXPECT_EQ(rowOf(order).real_stability_limit, (all.end() - 1)->real_stability_limit);
    EXPECT_EQ(rowOf(order).stages, all.begin()->terms);
  }
}

DenseOutputIntegrator stabilized(const Chain& chain, int order, double tolerance) {
  return {chain, std::make_unique<StabilizedTaylorStepper>(chain, order, tolerance)};
}

struct Measured {
  double error;
  double steps;
  double terms;  ///< of a step, on average
};

Measured measured(const char* name, int order, double tolerance) {
  test::Scene scene = test::referenceScene(name);
  DenseOutputIntegrator integrator = stabilized(scene.chain, order, tolerance);
  integrator.advance(scene.start, 1.0, 1);
  const auto steps = static_cast<double>(integrator.statistics().accepted);
  return {test::positionError(scene.start, test::referenceSolution(name, 1)), steps,
          static_cast<double>(integrator.forceEvaluations()) / steps};
}

double measuredOrder(const Measured& a, const Measured& b) {
  return std::log(a.error / b.error) / std::log(b.steps / a.steps);
}

// With steps that are long enough to be controlled each.
TEST(StabilizedTaylorStepper, ErrorsFallWithTheOrder) {
  const auto order_of = [](int order, double coarse_tolerance, double fine_tolerance) {
    const Measured coarse = measured("horizontal_11", order, coarse_tolerance);
    const Measured fine = measured("horizontal_11", order, fine_tolerance);
    EXPECT_EQ(fine.terms, order);
    return measuredOrder(coarse, fine);
  };
  EXPECT_NEAR(order_of(4, 1e-3, 1e-6), 4.0, 0.3);
  const double order_8 = order_of(8, 1e-4, 1e-8);
  EXPECT_GT(order_8, 7.8);  // 9.1: the leading term cancels within 1 s
  EXPECT_LT(order_8, 9.5);
}

TEST(StabilizedTaylorStepper, ErrorsFallWithTheOrderWhereTermsAreAdded) {
  const Measured coarse4 = measured("lighter_100", 4, 1e-2);
  const Measured fine4 = measured("lighter_100", 4, 1e-4);
  EXPECT_GT(fine4.terms, 6.0);                           // 9.7 and 6.4
  EXPECT_NEAR(measuredOrder(coarse4, fine4), 4.0, 0.4);  // 4.04
  const Measured coarse8 = measured("light_100", 8, 1e-1);
  const Measured fine8 = measured("light_100", 8, 1e-4);
  EXPECT_GT(fine8.terms, 10.0);                   // 13.1 and 10.5
  EXPECT_GT(measuredOrder(coarse8, fine8), 7.5);  // 9.2
  EXPECT_LT(measuredOrder(coarse8, fine8), 10.0);
}

}  // namespace
}  // namespace spring_pendulum
