#include "simulation/advice/eigenvalues.hpp"

#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

constexpr SpringLaw kSpring{50.0, 1.0, 1.0};
constexpr double kGravity = 9.81;

Chain chainOf(Eigen::Index size) {
  AlignedNumbers masses(size);
  for (Eigen::Index i = 0; i < size; ++i) masses[i] = 1.0 + 0.25 * static_cast<double>(i);
  return {masses, kSpring, kGravity};
}

TEST(Eigenvalues, OfOneHangingSpringAreThoseOfItsTwoOscillations) {
  const Chain chain = chainOf(2);
  const double mass = chain.masses()[1];
  const double length = 1.0 + mass * kGravity / kSpring.stiffness;
  State state(2);
  state.y()[1] = -length;
  std::vector<std::complex<double>> found = eigenvalues(chain, state);
  ASSERT_EQ(found.size(), 4U);
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.imag() < b.imag(); });
  const double decay = 0.5 * kSpring.damping / mass;
  const double along = std::sqrt(kSpring.stiffness / mass - decay * decay);
  const double across = std::sqrt(kGravity / length);
  // Measured: at most 9e-16.
  EXPECT_LT(std::abs(found[3] - std::complex<double>(-decay, along)), 1e-12);
  EXPECT_LT(std::abs(found[2] - std::complex<double>(0.0, across)), 1e-12);
  EXPECT_LT(std::abs(found[1] - std::conj(found[2])), 1e-12);
  EXPECT_LT(std::abs(found[0] - std::conj(found[3])), 1e-12);
}

TEST(Eigenvalues, HaveTheTraceAndTheSquaresOfTheNumericalJacobian) {
  const Chain chain = chainOf(4);
  State state(4);
  for (int i = 0; i < 4; ++i) {
    state.values().row(i) << 0.9 * i, -0.3 * i * i, 0.4 * i, std::sin(1.0 * i);
  }
  Eigen::MatrixXd jacobian(16, 16);
  constexpr double kStep = 1e-5;
  for (Eigen::Index j = 0; j < 16; ++j) {
    State before = state, after = state, slope_before, slope_after;
    before.values().data()[j] -= kStep;
    after.values().data()[j] += kStep;
    computeSlope(chain, before, slope_before);
    computeSlope(chain, after, slope_after);
    const Eigen::MatrixXd change = (slope_after.values() - slope_before.values()) / (2.0 * kStep);
    jacobian.col(j) = Eigen::Map<const Eigen::VectorXd>(change.data(), 16);
  }
  // The fixed particle only adds eigenvalues 0: its rows of the Jacobian are 0.
  std::complex<double> sum = 0.0, squares = 0.0, cubes = 0.0;
  for (const std::complex<double>& value : eigenvalues(chain, state)) {
    sum += value;
    squares += value * value;
    cubes += value * value * value;
  }
  // Measured: 9e-10, 8e-9 and 2e-7.
  EXPECT_NEAR(sum.real(), jacobian.trace(), 1e-6);
  EXPECT_NEAR(squares.real(), (jacobian * jacobian).trace(), 1e-5);
  EXPECT_NEAR(cubes.real(), (jacobian * jacobian * jacobian).trace(), 1e-4);
}

TEST(Eigenvalues, OfOneParticleAreNone) {
  EXPECT_TRUE(eigenvalues(chainOf(1), State(1)).empty());
}

TEST(Eigenvalues, RefuseAStateThatIsNotFinite) {
  State state(2);
  state.x()[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(eigenvalues(chainOf(2), state), InputError);
}

}  // namespace
}  // namespace spring_pendulum
