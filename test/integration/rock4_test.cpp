#include <spring_pendulum/integration/error_controlled.hpp>
#include <spring_pendulum/integration/rock4.hpp>
#include <spring_pendulum/model/energy.hpp>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>

#include <support/dense_output.hpp>
#include <support/order_conditions.hpp>
#include <support/reference.hpp>

namespace spring_pendulum {
namespace {

// A method as the explicit Runge-Kutta method that it is: a_ij of the stages and of the state after
// the step, whose slope the error estimate uses too.
Eigen::MatrixXd rungeKuttaMatrix(const Rock4Coefficients& method) {
  const auto n = static_cast<Eigen::Index>(method.recurrenceCount());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + 5, n + 5);
  Eigen::MatrixXd inner = Eigen::MatrixXd::Zero(n + 1, n + 5);
  for (Eigen::Index j = 1; j <= n; ++j) {
    const auto& row = method.recurrences[static_cast<std::size_t>(j - 1)];
    const Eigen::Index before = std::max<Eigen::Index>(j - 2, 0);
    inner.row(j) = inner.row(j - 1) + row.kappa * (inner.row(before) - inner.row(j - 1));
    inner(j, j - 1) += row.mu;
  }
  a.topRows(n) = inner.topRows(n);
  a.bottomRows(5).rowwise() += inner.row(n);
  const auto& c = method.finish;
  a(n + 1, n) += c[0];
  a.row(n + 2).segment(n, 2) += Eigen::RowVector2d(c[1], c[2]);
  a.row(n + 3).segment(n, 3) += Eigen::RowVector3d(c[3], c[4], c[5]);
  a.row(n + 4).segment(n, 4) += Eigen::RowVector4d(c[6], c[7], c[8], c[9]);
  return a;
}

Eigen::VectorXd elementaryWeights(const Eigen::MatrixXd& a, const test::Tree& tree) {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(a.rows());
  for (const test::Tree& branch : tree.branches) {
    weights.array() *= (a * elementaryWeights(a, branch)).array();
  }
  return weights;
}

double orderResidual(const Rock4Coefficients& method, int order) {
  const Eigen::MatrixXd a = rungeKuttaMatrix(method);
  const Eigen::VectorXd b = a.bottomRows(1).transpose();
  double largest = 0.0;
  for (const test::Tree& tree : test::rootedTrees(order)) {
    largest = std::max(largest, std::abs(b.dot(elementaryWeights(a, tree)) - 1.0 / tree.density()));
  }
  return largest;
}

// Largest term of the error estimate that belongs to a tree of up to `order`.
double estimate(const Rock4Coefficients& method, int order) {
  const Eigen::MatrixXd a = rungeKuttaMatrix(method);
  Eigen::VectorXd e = Eigen::VectorXd::Zero(a.rows());
  e.tail(5) = Eigen::Map<const Eigen::VectorXd>(method.error.data(), 5);
  double largest = 0.0;
  for (const test::Tree& tree : test::rootedTrees(order)) {
    largest = std::max(largest, std::abs(e.dot(elementaryWeights(a, tree))));
  }
  return largest;
}

// R(z) of z' = λz, z = hλ, stage by stage as the method does it.
std::complex<double> stabilityFunction(const Rock4Coefficients& method, std::complex<double> z) {
  const Eigen::MatrixXd a = rungeKuttaMatrix(method);
  Eigen::VectorXcd stages = Eigen::VectorXcd::Ones(a.rows());
  for (Eigen::Index i = 1; i < a.rows(); ++i) {
    stages[i] += z * a.row(i).head(i).cast<std::complex<double>>().dot(stages.head(i));
  }
  return stages[a.rows() - 1];
}

TEST(Rock4, EveryMethodFulfilsTheOrderConditions) {
  for (const Rock4Coefficients& method : rock4Table()) {
    EXPECT_LT(orderResidual(method, 4), 1e-15) << method.stages;  // 1.1e-16
    EXPECT_GT(orderResidual(method, 5), 1e-4) << method.stages;   // not of order 5
    EXPECT_LT(estimate(method, 3), 1e-15) << method.stages;       // 6e-17
    EXPECT_GT(estimate(method, 4), 1e-3) << method.stages;
  }
}

TEST(Rock4, AnAlteredCoefficientBreaksTheOrder) {
  Rock4Coefficients method = rock4Table()[4];
  method.recurrences[2].kappa += 1e-6;
  EXPECT_GT(orderResidual(method, 4), 1e-8);
}

TEST(Rock4, EveryMethodIsStableAsFarAsTheTableSays) {
  for (const Rock4Coefficients& method : rock4Table()) {
    const double limit = method.real_stability_limit;
    double largest = 0.0;
    for (double x = 0.5; x < limit; x += 0.01) {
      largest = std::max(largest, std::abs(stabilityFunction(method, -x)));
    }
    EXPECT_LT(largest, 0.951) << method.stages;  // 0.9501
    EXPECT_GT(std::abs(stabilityFunction(method, -1.05 * limit)), 1.0) << method.stages;
    for (double y = 0.1; y <= findMethod("ROCK4").imaginary_stability_limit; y += 0.05) {
      EXPECT_LT(std::abs(stabilityFunction(method, {0.0, y})), 1.0) << method.stages << " " << y;
    }
  }
}

TEST(Rock4, TableOfMethodsStatesTheLargestLimit) {
  EXPECT_EQ(findMethod("ROCK4").real_stability_limit, rock4Table().back().real_stability_limit);
  EXPECT_EQ(findMethod("ROCK4").stages, rock4Table().front().stages);
}

ErrorControlled rock4(const Chain& chain, double tolerance) {
  return ErrorControlled(
      std::make_unique<Rock4Stepper>(chain, IntegratorOptions{tolerance, false, 1}));
}

TEST(Rock4, ErrorsFallWithOrderFour) {
  double error[2];
  double step[2];
  for (int i = 0; i < 2; ++i) {
    test::Scene scene = test::referenceScene("horizontal_11");
    ErrorControlled integrator = rock4(scene.chain, i == 0 ? 1e-5 : 1e-8);
    integrator.advance(scene.start, 1.0, 1);
    error[i] = test::positionError(scene.start, test::referenceSolution("horizontal_11", 1));
    step[i] = 1.0 / static_cast<double>(integrator.statistics().accepted);
  }
  EXPECT_NEAR(std::log(error[0] / error[1]) / std::log(step[0] / step[1]), 4.0, 0.3);  // 4.16
}

TEST(Rock4, DenseOutputHasOrderThree) {
  const test::Scene scene = test::referenceScene("horizontal_11");
  const double order = test::denseOutputOrder(scene, 1e-3, 1e-6, [&scene](double tolerance) {
    return std::make_unique<Rock4Stepper>(scene.chain, IntegratorOptions{tolerance, false, 1});
  });
  EXPECT_NEAR(order, 3.0, 0.3);  // 2.97
}

TEST(Rock4, NeedsFarFewerEvaluationsThanStabilityAsksOfRungeKutta4) {
  test::Scene scene = test::referenceScene("lighter_100");
  ErrorControlled integrator = rock4(scene.chain, 1.0);
  integrator.advance(scene.start, 1.0, 1);
  EXPECT_LT(test::positionError(scene.start, test::referenceSolution("lighter_100", 1)), 1e-2);
  EXPECT_LT(integrator.forceEvaluations(), 3000);  // 1336; Runge-Kutta-4 5700
}

TEST(Rock4, HeatClosesTheEnergyBalance) {
  test::Scene scene = test::referenceScene("horizontal_11");
  const double before = computeEnergy(scene.chain, scene.start).total();
  const auto integrator = makeIntegrator("ROCK4", scene.chain, IntegratorOptions{1e-8, true, 1});
  integrator->advance(scene.start, 0.1, 20);
  const double after = computeEnergy(scene.chain, scene.start).total();
  EXPECT_GT(integrator->dissipatedEnergy(), 1.0);
  EXPECT_NEAR(before - after, integrator->dissipatedEnergy(), 1e-7);  // 1e-9
}

}  // namespace
}  // namespace spring_pendulum
