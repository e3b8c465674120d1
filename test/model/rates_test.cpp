#include <spring_pendulum/model/rates.hpp>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace spring_pendulum {
namespace {

// Largest rate of the dashpots of a straight chain, from a dense eigenvalue problem.
double denseRate(const Chain& chain) {
  const Eigen::Index size = chain.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i + 1 < size; ++i) {
    matrix.block<2, 2>(i, i) += chain.spring().damping * Eigen::Matrix2d{{1.0, -1.0}, {-1.0, 1.0}};
  }
  const Eigen::MatrixXd rates = chain.inverseMasses().asDiagonal() * matrix;
  return rates.eigenvalues().real().maxCoeff();
}

TEST(Rates, BoundTheFastestDampedMode) {
  const Eigen::VectorXd equal = Eigen::VectorXd::Constant(100, 1e-3);
  const Chain light(equal, SpringLaw{}, 9.81);
  EXPECT_GE(fastestDampingRate(light), denseRate(light));
  EXPECT_LT(fastestDampingRate(light), 1.001 * denseRate(light));
  Eigen::VectorXd alternating = Eigen::VectorXd::Ones(51);
  for (Eigen::Index i = 1; i < 51; i += 2) alternating[i] = 1e-4;
  const Chain stiff(alternating, SpringLaw{50.0, 3.0, 1.0}, 9.81);
  EXPECT_GE(fastestDampingRate(stiff), denseRate(stiff));
  EXPECT_LT(fastestDampingRate(stiff), 1.001 * denseRate(stiff));
}

TEST(Rates, WithoutDampingThereIsNone) {
  const Chain chain(Eigen::VectorXd::Ones(3), SpringLaw{50.0, 0.0, 1.0}, 9.81);
  EXPECT_EQ(fastestDampingRate(chain), 0.0);
}

}  // namespace
}  // namespace spring_pendulum
