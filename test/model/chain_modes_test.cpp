#include "model/chain_modes.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace spring_pendulum {
namespace {

/// Largest eigenvalue of M^-1/2 B^T D B M^-1/2 by a dense solver, without code of the library.
double denseLargest(const Chain& chain, const Eigen::VectorXd& stiffness) {
  const Eigen::Index n = chain.size() - 1;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    matrix(i, i) += stiffness[i] * chain.inverseMasses()[i + 1];
    if (i == 0) continue;
    matrix(i - 1, i - 1) += stiffness[i] * chain.inverseMasses()[i];
    matrix(i, i - 1) = matrix(i - 1, i) =
        -stiffness[i] * std::sqrt(chain.inverseMasses()[i] * chain.inverseMasses()[i + 1]);
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues().maxCoeff();
}

Chain randomChain(unsigned seed, Eigen::Index size) {
  std::mt19937 generator(seed);
  Eigen::VectorXd masses(size);
  for (Eigen::Index i = 0; i < size; ++i)
    masses[i] = std::pow(10.0, -5.0 + 6.0 * static_cast<double>(generator()) / 4294967296.0);
  return {masses, SpringLaw{}, 9.81};
}

void expectFromAbove(double value, double exact) {
  EXPECT_GE(value, exact * (1.0 - 1e-12));
  EXPECT_LE(value, exact * (1.0 + 1e-4));
}

TEST(ChainModes, SpringModesAgreeWithADenseSolver) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Chain chain = randomChain(seed, 2 + static_cast<Eigen::Index>(seed));
    expectFromAbove(largestSpringMode(chain),
                    denseLargest(chain, Eigen::VectorXd::Ones(chain.size() - 1)));
  }
}

TEST(ChainModes, StiffestSpringJoinsTheLightestPair) {
  const Chain chain((Eigen::VectorXd(4) << 1.0, 2.0, 0.5, 4.0).finished(), SpringLaw{}, 9.81);
  EXPECT_DOUBLE_EQ(stiffestSpring(chain), 1.0 / 2.0 + 1.0 / 0.5);
  const Chain short_chain((Eigen::VectorXd(2) << 0.001, 2.0).finished(), SpringLaw{}, 9.81);
  EXPECT_DOUBLE_EQ(stiffestSpring(short_chain), 0.5);  // the first particle is fixed
  EXPECT_GE(largestSpringMode(Chain(Eigen::Vector2d(1, 1e-308), SpringLaw{}, 9.81)), 1e308);
}

TEST(ChainModes, UniformChainHasTheClosedForm) {
  // One end fixed, one free: 4/m sin²((2n - 1)/(2n + 1) π/2) for n springs.
  const Chain chain(Eigen::VectorXd::Constant(31, 0.5), SpringLaw{}, 9.81);
  const double sine = std::sin(59.0 / 61.0 * std::acos(0.0));
  expectFromAbove(largestSpringMode(chain), 4.0 / 0.5 * sine * sine);
}

TEST(ChainModes, OneParticleSwingsAsAPendulum) {
  const Chain chain(Eigen::VectorXd::Ones(2), SpringLaw{}, 9.81);
  EXPECT_DOUBLE_EQ(slowSwing(chain), std::sqrt(9.81 / (1.0 + 9.81 / 50.0)));
}

TEST(ChainModes, LongChainsSwingAtTheirFreeEnd) {
  const Chain stiff(Eigen::VectorXd::Ones(11), {1e9, 1.0, 1.0}, 9.81);
  EXPECT_NEAR(slowSwing(stiff), std::sqrt(9.81 * 55.0 / 385.0), 1e-6);
  const Chain longer(Eigen::VectorXd::Ones(500), {1e9, 1.0, 1.0}, 9.81);
  EXPECT_NEAR(slowSwing(longer), slowSwing(stiff), 1e-5);
}

TEST(ChainModes, AreZeroWhereNothingMoves) {
  const Chain fixed(Eigen::VectorXd::Ones(1), SpringLaw{}, 9.81);
  EXPECT_EQ(largestSpringMode(fixed), 0.0);
  EXPECT_EQ(stiffestSpring(fixed), 0.0);
  EXPECT_EQ(slowSwing(fixed), 0.0);
  const Chain floating(Eigen::VectorXd::Ones(3), SpringLaw{}, 0.0);
  EXPECT_EQ(slowSwing(floating), 0.0);
}

}  // namespace
}  // namespace spring_pendulum
