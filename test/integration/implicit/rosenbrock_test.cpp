#include "integration/implicit/rosenbrock.hpp"

#include "integration/error_control/dense_output_integrator.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/energy.hpp>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <memory>
#include <vector>

#include <support/dense_output.hpp>
#include <support/order_conditions.hpp>
#include <support/reference.hpp>

namespace spring_pendulum {
namespace {

// The coefficients in the form in which the order conditions are written, Hairer and Wanner,
// Solving ODEs II, section IV.7: alpha, beta = alpha + Gamma and b with u = Gamma k.
struct Coefficients {
  Eigen::MatrixXd alpha, beta;
  Eigen::VectorXd weights, embedded_weights;
};

Coefficients coefficientsOf(const RosenbrockTableau& tableau) {
  const auto stages = static_cast<Eigen::Index>(tableau.stages);
  Eigen::MatrixXd a(stages, stages), inverse(stages, stages);
  Eigen::VectorXd m(stages), e(stages);
  for (Eigen::Index i = 0; i < stages; ++i) {
    const auto row = static_cast<std::size_t>(i);
    m[i] = tableau.m[row];
    e[i] = tableau.e[row];
    for (Eigen::Index j = 0; j < stages; ++j) {
      const auto column = static_cast<std::size_t>(j);
      a(i, j) = tableau.a[row][column];
      inverse(i, j) = (i == j ? 1.0 / tableau.gamma : 0.0) - tableau.c[row][column];
    }
  }
  Eigen::MatrixXd gamma = Eigen::MatrixXd::Zero(stages, stages);  // both are lower triangular
  for (Eigen::Index j = 0; j < stages; ++j) {
    for (Eigen::Index i = j; i < stages; ++i) {
      const double rest = inverse.row(i).head(i).dot(gamma.col(j).head(i));
      gamma(i, j) = ((i == j ? 1.0 : 0.0) - rest) / inverse(i, i);
    }
  }
  return {a * gamma, a * gamma + gamma, gamma.transpose() * m, gamma.transpose() * (m - e)};
}

// As elementary weights of Runge-Kutta methods, with beta along single branches.
Eigen::VectorXd elementaryWeights(const Coefficients& method, const test::Tree& tree) {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(method.weights.size());
  const Eigen::MatrixXd& matrix = tree.branches.size() == 1 ? method.beta : method.alpha;
  for (const test::Tree& branch : tree.branches) {
    weights.array() *= (matrix * elementaryWeights(method, branch)).array();
  }
  return weights;
}

double residual(const Coefficients& method, const Eigen::VectorXd& weights, int order) {
  double largest = 0.0;
  for (const test::Tree& tree : test::rootedTrees(order)) {
    const double sum = weights.dot(elementaryWeights(method, tree));
    largest = std::max(largest, std::abs(sum - 1.0 / tree.density()));
  }
  return largest;
}

TEST(Rodas5P, FulfilsTheOrderConditions) {
  const Coefficients method = coefficientsOf(kRodas5PTableau);
  EXPECT_LT(residual(method, method.weights, 5), 1e-12);           // 1.9e-14
  EXPECT_GT(residual(method, method.weights, 6), 1e-5);            // not of order 6
  EXPECT_LT(residual(method, method.embedded_weights, 4), 1e-12);  // 1.8e-14
  EXPECT_GT(residual(method, method.embedded_weights, 5), 1e-5);   // not of order 5
}

TEST(Rodas5P, AnAlteredCoefficientBreaksTheOrder) {
  RosenbrockTableau tableau = kRodas5PTableau;
  tableau.c[4][2] += 1e-4;
  const Coefficients method = coefficientsOf(tableau);
  EXPECT_GT(residual(method, method.weights, 5), 1e-7);
}

// R(z) of z' = λz, z = hλ.
std::complex<double> stabilityFunction(const Coefficients& method, std::complex<double> z) {
  std::vector<std::complex<double>> slopes;
  std::complex<double> result = 1.0;
  for (Eigen::Index i = 0; i < method.weights.size(); ++i) {
    std::complex<double> argument = 1.0;
    for (Eigen::Index j = 0; j < i; ++j) {
      argument += z * method.beta(i, j) * slopes[static_cast<std::size_t>(j)];
    }
    slopes.push_back(argument / (1.0 - z * method.beta(i, i)));
    result += z * method.weights[i] * slopes.back();
  }
  return result;
}

TEST(Rodas5P, IsAStableAndLStable) {
  const Coefficients method = coefficientsOf(kRodas5PTableau);
  double largest = 0.0;
  // By the maximum principle the imaginary axis decides on the whole left half-plane.
  for (double y = 1e-2; y < 1e4; y *= 1.02) {
    largest = std::max(largest, std::abs(stabilityFunction(method, {0.0, y})));
  }
  EXPECT_LE(largest, 1.0 + 1e-12);
  EXPECT_LT(std::abs(stabilityFunction(method, {-1e8, 0.0})), 1e-6);  // 1.3e-7
}

// Error at 1 s, and the mean step, m and s.
struct Run {
  double error;
  double step;
};

Run runScene(const std::string& name, double tolerance, const RosenbrockTableau& tableau) {
  test::Scene scene = test::referenceScene(name);
  DenseOutputIntegrator integrator(
      std::make_unique<RosenbrockStepper>(scene.chain, tableau, tolerance));
  integrator.advance(scene.start, 1.0, 1);
  return {test::positionError(scene.start, test::referenceSolution(name, 1)),
          1.0 / static_cast<double>(integrator.statistics().accepted)};
}

double measuredOrder(const RosenbrockTableau& tableau) {
  const Run coarse = runScene("horizontal_11", 1e-5, tableau);
  const Run fine = runScene("horizontal_11", 1e-8, tableau);
  return std::log(coarse.error / fine.error) / std::log(coarse.step / fine.step);
}

TEST(Rodas5P, ErrorsFallWithOrderFive) {
  EXPECT_NEAR(measuredOrder(kRodas5PTableau), 5.0, 0.4);  // 5.2
}

TEST(Rodas5P, DenseOutputHasOrderFour) {
  const test::Scene scene = test::referenceScene("horizontal_11");
  const double order = test::denseOutputOrder(scene, 1e-3, 1e-6, [&scene](double tolerance) {
    return std::make_unique<RosenbrockStepper>(scene.chain, kRodas5PTableau, tolerance);
  });
  EXPECT_NEAR(order, 4.0, 0.4);  // 3.98
}

TEST(Rodas5P, DissipatedEnergyClosesTheBalance) {
  test::Scene scene = test::referenceScene("horizontal_11");
  const double before = computeEnergy(scene.chain, scene.start).total();
  const auto integrator = makeIntegrator("Rodas5P", scene.chain, IntegratorOptions{1e-8, true, 1});
  integrator->advance(scene.start, 0.1, 20);
  const double after = computeEnergy(scene.chain, scene.start).total();
  EXPECT_GT(integrator->dissipatedEnergy(), 1.0);
  EXPECT_NEAR(before - after, integrator->dissipatedEnergy(), 1e-8);  // 9e-10
}

TEST(Rodas5P, CountsItsEvaluations) {
  test::Scene scene = test::referenceScene("light_100");
  DenseOutputIntegrator integrator(
      std::make_unique<RosenbrockStepper>(scene.chain, kRodas5PTableau, 1e-3));
  integrator.advance(scene.start, 1.0, 1);
  const StepStatistics statistics = integrator.statistics();
  EXPECT_GT(statistics.accepted, 10);
  EXPECT_EQ(statistics.force_evaluations,
            findMethod("Rodas5P").stages * (statistics.accepted + statistics.rejected));
}

}  // namespace
}  // namespace spring_pendulum
