#include "integration/implicit/radau_stepper.hpp"

#include "integration/error_control/dense_output_integrator.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/energy.hpp>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <memory>
#include <string>
#include <vector>

#include "support/dense_output.hpp"
#include "support/exact_motion.hpp"
#include "support/reference.hpp"

namespace spring_pendulum {
namespace {

using radau::kNodes;
using radau::kStages;

TEST(RadauCoefficients, FulfilTheOrderConditions) {
  double quadrature = 0.0, collocation = 0.0, ninth = 0.0, embedded = 0.0;
  for (int k = 1; k <= 10; ++k) {
    double end = 0.0;
    for (std::size_t i = 0; i < kStages; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < kStages; ++j) {
        sum += radau::kMatrix[i][j] * std::pow(kNodes[j], k - 1);
      }
      if (k <= 5) collocation = std::max(collocation, std::abs(sum - std::pow(kNodes[i], k) / k));
      if (i + 1 == kStages) end = std::abs(sum - 1.0 / k);
    }
    (k <= 9 ? quadrature : ninth) = std::max(k <= 9 ? quadrature : 0.0, end);
    // z = t^k of slope k t^(k-1): the error formula sees no polynomial up to degree 5.
    double error = k == 1 ? 1.0 / radau::kReal.value : 0.0;
    for (std::size_t i = 0; i < kStages; ++i) error += radau::kError[i] * std::pow(kNodes[i], k);
    if (k <= 5) embedded = std::max(embedded, std::abs(error));
    if (k == 6) {
      EXPECT_GT(std::abs(error), 1e-3);
    }
  }
  EXPECT_LT(quadrature, 1e-15);   // 1e-16
  EXPECT_LT(collocation, 1e-15);  // 1e-16
  EXPECT_LT(embedded, 1e-14);
  EXPECT_GT(ninth, 1e-7);  // not of order 10
}

TEST(RadauCoefficients, EigenvectorsDiagonaliseTheMatrix) {
  Eigen::MatrixXcd rebuilt = Eigen::MatrixXcd::Zero(kStages, kStages);
  const auto standard = [](Complex a) { return std::complex<double>(a.re, a.im); };
  for (std::size_t i = 0; i < kStages; ++i) {
    for (std::size_t j = 0; j < kStages; ++j) {
      const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
      rebuilt(row, column) = radau::kReal.right[i] * radau::kReal.left[j] / radau::kReal.value;
      for (const auto& pair : radau::kPairs) {
        rebuilt(row, column) +=
            (standard(pair.right[i]) * standard(pair.left[j]) / standard(pair.value)).real();
      }
      EXPECT_NEAR(rebuilt(row, column).real(), radau::kMatrix[i][j], 1e-15);
    }
  }
}

// Of the pendulum of 1 kg at 1 s: the error in m, and the mean step in s.
struct ErrorAndStep {
  double error;
  double step;
};

ErrorAndStep runPendulum(double tolerance) {
  const Chain chain(Eigen::VectorXd::Ones(2), SpringLaw{}, 9.81);
  State exact(2);
  exact.x()[1] = 1.0;
  State state = exact;
  makeIntegrator("Taylor-12", chain, {1e-13})->advance(exact, 1.0, 1);
  DenseOutputIntegrator integrator(chain, std::make_unique<RadauStepper>(chain, tolerance));
  integrator.advance(state, 1.0, 1);
  return {test::positionError(state, exact),
          1.0 / static_cast<double>(integrator.statistics().accepted)};
}

TEST(Radau, ErrorsFallWithTheOrder) {
  const ErrorAndStep coarse = runPendulum(1e-5);
  const ErrorAndStep fine = runPendulum(1e-8);
  const double order = std::log(coarse.error / fine.error) / std::log(coarse.step / fine.step);
  EXPECT_NEAR(order, 9.0, 0.7);  // 8.98
}

TEST(Radau, DenseOutputHasTheOrderOfTheStages) {
  const test::Scene scene = test::referenceScene("horizontal_11");
  const double order = test::denseOutputOrder(scene, 1e-4, 1e-7, [&scene](double tolerance) {
    return std::make_unique<RadauStepper>(scene.chain, tolerance);
  });
  EXPECT_NEAR(order, 5.0, 0.6);
}

TEST(Radau, DissipatedEnergyClosesTheBalance) {
  test::Scene scene = test::referenceScene("horizontal_11");
  const double before = computeEnergy(scene.chain, scene.start).total();
  const auto integrator = makeIntegrator("Radau-9", scene.chain, IntegratorOptions{1e-8, true, 1});
  integrator->advance(scene.start, 0.1, 20);
  const double after = computeEnergy(scene.chain, scene.start).total();
  EXPECT_GT(integrator->dissipatedEnergy(), 1.0);
  EXPECT_NEAR(before - after, integrator->dissipatedEnergy(), 1e-8);
}

// Pendulum of two particles, let go level.
StepStatistics pendulum(double mass, double tolerance, State& state, const SpringLaw& law = {}) {
  const Chain chain(Eigen::Vector2d(1.0, mass), law, 9.81);
  DenseOutputIntegrator integrator(chain, std::make_unique<RadauStepper>(chain, tolerance));
  state = State(2);
  state.x()[1] = 1.0;
  integrator.advance(state, 10.0, 1);
  return integrator.statistics();
}

// The iteration contracts alike for all masses, so the steps hardly depend on them.
TEST(Radau, StepsDoNotDependOnTheMass) {
  for (const double mass : {1e-5, 1e-7, 1e-9}) {
    State coarse, fine, finest;
    const StepStatistics at_3 = pendulum(mass, 1e-3, coarse);
    const StepStatistics at_6 = pendulum(mass, 1e-6, fine);
    const StepStatistics at_9 = pendulum(mass, 1e-9, finest);
    EXPECT_LT(at_3.accepted + at_3.rejected, 120) << mass;         // 97, 97, 99
    EXPECT_LT(at_6.accepted + at_6.rejected, 250) << mass;         // 211
    EXPECT_LT(at_9.accepted + at_9.rejected, 900) << mass;         // 823
    EXPECT_LT(test::positionError(coarse, finest), 1e-3) << mass;  // 4e-6
    EXPECT_LT(test::positionError(fine, finest), 1e-6) << mass;    // 6e-10
  }
}

// Small masses and large stiffness, against motions in extended precision.
TEST(Radau, KeepsItsToleranceOnLightParticles) {
  struct Case {
    std::vector<double> masses;
    SpringLaw spring;
  };
  const std::vector<Case> cases{{{1.0, 1e-5}, {}},
                                {{1.0, 1e-7}, {}},
                                {{1.0, 1e-9}, {}},
                                {{1.0, 1.0, 1e-9}, {}},
                                {{1.0, 1e-6, 1e-6}, {}},
                                {{1.0, 1.0, 1e-4, 1e-8}, {}},
                                {{1.0, 1e-5}, {1e6, 1e2, 1.0}},
                                {{1.0, 1e-7}, {50.0, 1e3, 1.0}}};
  for (const Case& c : cases) {
    const auto size = static_cast<Eigen::Index>(c.masses.size());
    const Eigen::Map<const Eigen::VectorXd> masses(c.masses.data(), size);
    test::Scene scene{"", Chain(masses, c.spring, 9.81), State(size)};
    for (Eigen::Index i = 1; i < size; ++i) scene.start.x()[i] = static_cast<double>(i);
    const auto exact = test::solveExactly(scene, 0.5, 4, 20.0, test::OracleMethod::kRadau);
    ASSERT_TRUE(exact) << c.masses.back();
    for (const double tolerance : {1e-3, 1e-6, 1e-8}) {
      const auto integrator = makeIntegrator("Radau-9", scene.chain, {tolerance});
      State state = scene.start;
      double worst = 0.0;
      for (const State& truth : *exact) {
        integrator->advance(state, 0.5, 1);
        worst = std::max(worst, test::positionError(state, truth) / tolerance);
      }
      EXPECT_LT(worst, 2.0) << c.masses.back() << " kg, " << tolerance << " m";
    }
  }
}

}  // namespace
}  // namespace spring_pendulum
