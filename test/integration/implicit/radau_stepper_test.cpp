#include "integration/implicit/radau_stepper.hpp"

#include "integration/error_control/dense_output_integrator.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <memory>
#include <string>
#include <vector>

#include "support/reference.hpp"
#include "support/scenes.hpp"

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
      for (std::size_t j = 0; j < kStages; ++j)
        sum += radau::kMatrix[i][j] * std::pow(kNodes[j], k - 1);
      if (k <= 5) collocation = std::max(collocation, std::abs(sum - std::pow(kNodes[i], k) / k));
      if (i + 1 == kStages) end = std::abs(sum - 1.0 / k);
    }
    (k <= 9 ? quadrature : ninth) = std::max(k <= 9 ? quadrature : 0.0, end);
    // z = t^k of slope k t^(k-1): the error formula sees no polynomial up to degree 5.
    double error = k == 1 ? 1.0 / radau::kReal.value : 0.0;
    for (std::size_t i = 0; i < kStages; ++i) error += radau::kError[i] * std::pow(kNodes[i], k);
    if (k <= 5) embedded = std::max(embedded, std::abs(error));
    EXPECT_TRUE(k != 6 || std::abs(error) > 1e-3) << error;
  }
  EXPECT_LT(quadrature, 1e-15);   // 1e-16
  EXPECT_LT(collocation, 1e-15);  // 1e-16
  EXPECT_LT(embedded, 1e-14);
  EXPECT_GT(ninth, 1e-7);  // not of order 10
}

TEST(RadauCoefficients, EigenvectorsDiagonaliseTheMatrix) {
  Eigen::MatrixXcd rebuilt = Eigen::MatrixXcd::Zero(kStages, kStages);
  const auto standard = [](Complex a) { return std::complex<double>(a.re, a.im); };
  for (std::size_t i = 0; i < kStages; ++i)
    for (std::size_t j = 0; j < kStages; ++j) {
      const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
      rebuilt(row, column) = radau::kReal.right[i] * radau::kReal.left[j] / radau::kReal.value;
      for (const auto& pair : radau::kPairs)
        rebuilt(row, column) +=
            (standard(pair.right[i]) * standard(pair.left[j]) / standard(pair.value)).real();
      EXPECT_NEAR(rebuilt(row, column).real(), radau::kMatrix[i][j], 1e-15);
    }
}

// Of the pendulum of 1 kg at 1 s: the error in m, and the mean step in s.
struct ErrorAndStep {
  double error, step;
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
    EXPECT_LT(at_3.accepted, 100) << mass;                         // 81, 81, 82
    EXPECT_LT(at_6.accepted, 250) << mass;                         // 206
    EXPECT_LT(at_9.accepted, 900) << mass;                         // 823
    EXPECT_LT(test::positionError(coarse, finest), 1e-3) << mass;  // 4e-6
    EXPECT_LT(test::positionError(fine, finest), 1e-6) << mass;    // 6e-10
  }
}

// The direction of the spring is unknown at the start: the hand falls more slowly than the particle.
TEST(Radau, AParticleLeavesTheHandThatIsInItsPlace) {
  const Chain chain = Chain(Eigen::Vector2d::Ones(), {}, 9.81).drivenBy({{{0, {1.0, -7.0}}}, {}});
  State state(2), expected(2);
  makeIntegrator("Radau-9", chain)->advance(state, 0.3, 1);
  makeIntegrator("Taylor-8", chain)->advance(expected, 0.3, 1);
  EXPECT_LT(test::positionError(state, expected), 1e-5);
}

// Small masses and large stiffness. The positions after 0.5 and 2 s are those of a Radau IIA method of
// order 9 in extended precision with dense algebra and with the tensions as unknowns.
TEST(Radau, KeepsItsToleranceOnLightParticles) {
  struct Case {
    std::vector<double> masses;
    std::vector<double> exact[2];  ///< x and y of the moving particles, m
    SpringLaw spring = {};
  };
  const std::vector<Case> cases{
      {{1.0, 1e-5}, {{0.391055661, -0.920372670}, {0.793554031, -0.608506198}}},
      {{1.0, 1e-9}, {{0.391048792, -0.920369949}, {0.793566194, -0.608483933}}},
      {{1.0, 1.0, 1e-9},
       {{0.780434225, -1.098103721, 1.772738335, -1.221928410},
        {-0.638804843, -1.271585357, 0.106110316, -1.938744564}}},
      {{1.0, 1e-6, 1e-6},
       {{0.540030106, -0.841646384, 1.473466778, -1.200389478},
        {-0.464416149, -0.885617696, -1.434128672, -1.129867804}}},
      {{1.0, 1.0, 1e-4, 1e-8},
       {{0.780452131, -1.098101765, 1.772783630, -1.221928447, 2.772774596, -1.226179919},
        {-0.638833681, -1.271376650, 0.106302043, -1.938401591, 0.446820406, -2.878639464}}},
      {{1.0, 1e-5}, {{0.391048792, -0.920369949}, {0.793566195, -0.608483932}}, {1e6, 1e2, 1.0}},
      {{1.0, 1e-7}, {{0.391048792, -0.920369949}, {0.793566195, -0.608483936}}, {50.0, 1e3, 1.0}}};
  for (const Case& c : cases) {
    const auto size = static_cast<Eigen::Index>(c.masses.size());
    const Eigen::Map<const Eigen::VectorXd> masses(c.masses.data(), size);
    for (const double tolerance : {1e-3, 1e-6, 1e-8}) {
      const auto integrator = makeIntegrator("Radau-9", Chain(masses, c.spring, 9.81), {tolerance});
      State state = test::straightLine(size, 1.0, 0.0);
      for (const auto& exact : c.exact) {
        integrator->advance(state, 0.5, &exact == c.exact ? 1 : 3);
        State truth = state;
        const Eigen::Map<const Eigen::Matrix2Xd> places(exact.data(), 2, size - 1);
        truth.positions().bottomRows(size - 1) = places.transpose();
        EXPECT_LT(test::positionError(state, truth), 2.0 * tolerance)
            << c.masses.back() << " kg, " << tolerance << " m";
      }
    }
  }
}

}  // namespace
}  // namespace spring_pendulum
