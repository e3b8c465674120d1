#include "integration/implicit/chain_solver.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <random>

namespace spring_pendulum {
namespace {

struct System {
  Chain chain;
  SpringJacobian jacobian;
};

Eigen::VectorXd randomNumbers(std::mt19937& random, Eigen::Index size, double low, double high) {
  std::uniform_real_distribution<double> uniform(low, high);
  return Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(random); });
}

System randomSystem(Eigen::Index particles, unsigned seed) {
  std::mt19937 random(seed);
  System system{Chain(randomNumbers(random, particles, 0.1, 2.0), SpringLaw{}, 9.81),
                SpringJacobian(particles - 1)};
  State state(particles);
  for (int column = 0; column < 4; ++column) {
    state.values().col(column) = randomNumbers(random, particles, -1.0, 1.0);
  }
  state.x() += Eigen::VectorXd::LinSpaced(particles, 0.0, 2.0 * static_cast<double>(particles));
  computeSpringJacobian(system.chain.spring(), state.values(), system.jacobian);
  return system;
}

// M - q C - q² K of the moving particles, unknowns x_2, y_2, x_3, ...
Eigen::MatrixXd denseMatrix(const System& system, double q) {
  const Eigen::Index size = system.chain.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2 * size, 2 * size);
  for (Eigen::Index i = 0; i < size; ++i) {
    matrix.block<2, 2>(2 * i, 2 * i).diagonal().setConstant(system.chain.masses()[i]);
  }
  for (Eigen::Index i = 0; i + 1 < size; ++i) {
    const Eigen::RowVector4d row =
        q * system.jacobian.damping.row(i) + q * q * system.jacobian.stiffness.row(i);
    Eigen::Matrix2d block;
    block << row[0], row[1], row[2], row[3];
    matrix.block<2, 2>(2 * i, 2 * i) += block;
    matrix.block<2, 2>(2 * i + 2, 2 * i + 2) += block;
    matrix.block<2, 2>(2 * i, 2 * i + 2) -= block;
    matrix.block<2, 2>(2 * i + 2, 2 * i) -= block;
  }
  return matrix.bottomRightCorner(2 * size - 2, 2 * size - 2);
}

// Largest difference to a dense solution with pivoting, relative to the solution.
double errorOfSolve(Eigen::Index particles, double q) {
  const System system = randomSystem(particles, static_cast<unsigned>(particles));
  std::mt19937 random(1);
  Eigen::VectorXd x = randomNumbers(random, particles, -1.0, 1.0);
  Eigen::VectorXd y = randomNumbers(random, particles, -1.0, 1.0);
  Eigen::VectorXd right_side(2 * particles - 2);
  for (Eigen::Index i = 1; i < particles; ++i) right_side.segment<2>(2 * i - 2) << x[i], y[i];
  const Eigen::VectorXd dense = denseMatrix(system, q).partialPivLu().solve(right_side);
  ChainSolver solver(system.chain);
  solver.factor(system.jacobian, q);
  solver.solve(x.data(), y.data());
  double largest = 0.0;
  for (Eigen::Index i = 1; i < particles; ++i) {
    largest =
        std::max({largest, std::abs(x[i] - dense[2 * i - 2]), std::abs(y[i] - dense[2 * i - 1])});
  }
  return largest / dense.cwiseAbs().maxCoeff();
}

TEST(ChainSolver, SolvesAsADenseSolverDoes) {
  for (Eigen::Index particles = 2; particles <= 20; ++particles) {
    EXPECT_LT(errorOfSolve(particles, 0.01), 1e-13) << particles;  // 3e-16
    EXPECT_LT(errorOfSolve(particles, 0.2), 1e-11) << particles;   // 1e-15
  }
  EXPECT_LT(errorOfSolve(300, 0.01), 1e-13);
}

TEST(ChainSolver, TakesAChainWithoutMovingParticles) {
  const Chain chain(Eigen::VectorXd::Ones(1), SpringLaw{}, 9.81);
  ChainSolver solver(chain);
  solver.factor(SpringJacobian(0), 0.1);
  double x = 3.0, y = 4.0;
  solver.solve(&x, &y);
  EXPECT_EQ(x, 3.0);
  EXPECT_EQ(y, 4.0);
}

}  // namespace
}  // namespace spring_pendulum
