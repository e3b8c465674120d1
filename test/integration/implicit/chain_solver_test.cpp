#include "integration/implicit/chain_solver.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <complex>
#include <random>
#include <vector>

namespace spring_pendulum {
namespace {

using Dense = Eigen::MatrixXcd;

struct System {
  Chain chain;
  std::vector<LinearSpring> springs;
};

Eigen::VectorXd randomNumbers(std::mt19937& random, Eigen::Index size, double low, double high) {
  std::uniform_real_distribution<double> uniform(low, high);
  return Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(random); });
}

System randomSystem(Eigen::Index particles, double lightest) {
  std::mt19937 random(static_cast<unsigned>(particles));
  Eigen::VectorXd masses = randomNumbers(random, particles, 0.1, 2.0);
  for (Eigen::Index i = 1; i < particles; i += 2) masses[i] *= lightest;
  System system{Chain(masses, SpringLaw{}, 9.81), {}};
  for (Eigen::Index i = 0; i + 1 < particles; ++i) {
    const Eigen::VectorXd ends = randomNumbers(random, 5, -1.0, 1.0);
    system.springs.push_back(
        linearSpring(system.chain.spring(), {2.0 + ends[0], ends[1]}, {ends[2], ends[3]}, ends[4]));
  }
  return system;
}

// M - q C - q² K of the moving particles, unknowns x_2, y_2, x_3, ...
Dense denseMatrix(const System& system, std::complex<double> q) {
  const Eigen::Index size = system.chain.size();
  Dense matrix = Dense::Zero(2 * size, 2 * size);
  for (Eigen::Index i = 0; i < size; ++i)
    matrix.block<2, 2>(2 * i, 2 * i).diagonal().setConstant(system.chain.masses()[i]);
  for (Eigen::Index i = 0; i + 1 < size; ++i) {
    const LinearSpring& spring = system.springs[static_cast<std::size_t>(i)];
    const Eigen::Vector2d r(spring.r.x, spring.r.y), a(spring.a.x, spring.a.y);
    const Eigen::Matrix2d along = r * r.transpose();
    const Eigen::Matrix2d stiffness =
        r * a.transpose() + spring.e * (Eigen::Matrix2d::Identity() - along);
    const Eigen::Matrix2cd block = q * system.chain.spring().damping * along + q * q * stiffness;
    matrix.block<2, 2>(2 * i, 2 * i) += block;
    matrix.block<2, 2>(2 * i + 2, 2 * i + 2) += block;
    matrix.block<2, 2>(2 * i, 2 * i + 2) -= block;
    matrix.block<2, 2>(2 * i + 2, 2 * i) -= block;
  }
  return matrix.bottomRightCorner(2 * size - 2, 2 * size - 2);
}

std::complex<double> standard(double a) {
  return a;
}
std::complex<double> standard(Complex a) {
  return {a.re, a.im};
}

// Largest residual of the dense equations, relative to the right-hand side.
template <typename Scalar>
double residual(Eigen::Index particles, Scalar q, double lightest = 1.0) {
  const System system = randomSystem(particles, lightest);
  std::mt19937 random(1);
  const auto size = static_cast<std::size_t>(particles);
  std::vector<Scalar> x(size), y(size);
  Eigen::VectorXcd right_side(2 * particles - 2), solution(2 * particles - 2);
  for (std::size_t i = 1; i < size; ++i) {
    x[i] = randomNumbers(random, 1, -1.0, 1.0)[0];
    y[i] = randomNumbers(random, 1, -1.0, 1.0)[0];
    right_side.segment<2>(2 * static_cast<Eigen::Index>(i) - 2) << standard(x[i]), standard(y[i]);
  }
  ChainSolver<Scalar> solver(system.chain);
  solver.factor(system.springs, q);
  solver.solve(x.data(), y.data());
  for (std::size_t i = 1; i < size; ++i)
    solution.segment<2>(2 * static_cast<Eigen::Index>(i) - 2) << standard(x[i]), standard(y[i]);
  const Dense matrix = denseMatrix(system, standard(q));
  const double scale =
      matrix.cwiseAbs().rowwise().sum().maxCoeff() * solution.cwiseAbs().maxCoeff();
  return (matrix * solution - right_side).cwiseAbs().maxCoeff() / scale;
}

TEST(ChainSolver, SolvesTheDenseEquations) {
  for (Eigen::Index particles = 2; particles <= 20; ++particles) {
    EXPECT_LT(residual(particles, 0.01), 1e-14) << particles;
    EXPECT_LT(residual(particles, Complex(0.01, -0.02)), 1e-14) << particles;
    EXPECT_LT(residual(particles, Complex(0.1, 0.05)), 1e-14) << particles;
  }
  EXPECT_LT(residual(300, Complex(0.01, 0.02)), 1e-14);
}

TEST(ChainSolver, TakesMassesOfAllSizes) {
  for (const double lightest : {1e-3, 1e-6, 1e-9}) {
    EXPECT_LT(residual(11, 0.01, lightest), 1e-13) << lightest;
    EXPECT_LT(residual(11, Complex(0.01, 0.02), lightest), 1e-13) << lightest;
  }
}

}  // namespace
}  // namespace spring_pendulum
