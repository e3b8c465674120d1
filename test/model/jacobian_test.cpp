#include "model/jacobian.hpp"

#include <spring_pendulum/model/dynamics.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

Chain threeParticles(const SpringLaw& law) {
  return {Eigen::VectorXd::Ones(3), law, 9.81};
}

State bentAndMoving() {
  State state(3);
  state.values() << 0.0, 0.0, 0.0, 0.0,  //
      0.7, -0.4, 1.3, -0.8,              //
      1.1, -1.9, -0.6, 2.1;
  return state;
}

// Largest difference of the blocks to central differences of springForceOn, relative to k_s.
double errorOfBlocks(const SpringLaw& law, State state) {
  const Chain chain = threeParticles(law);
  SpringJacobian jacobian(2);
  computeSpringJacobian(law, state.values(), jacobian);
  const double step = 1e-6;
  double largest = 0.0;
  for (Eigen::Index spring = 0; spring < 2; ++spring) {
    for (int column = 0; column < 4; ++column) {
      double& moved = state.values()(spring + 1, column);
      const double kept = moved;
      moved = kept + step;
      const PlaneVector<double> above = springForceOn(chain, state, spring);
      moved = kept - step;
      const PlaneVector<double> below = springForceOn(chain, state, spring);
      moved = kept;
      const SpringBlocks& blocks = column < 2 ? jacobian.stiffness : jacobian.damping;
      const int part = column % 2;
      const double by_x = (above.x - below.x) / (2.0 * step) - blocks(spring, part);
      const double by_y = (above.y - below.y) / (2.0 * step) - blocks(spring, 2 + part);
      largest = std::max({largest, std::abs(by_x), std::abs(by_y)});
    }
  }
  return largest / law.stiffness;
}

TEST(Jacobian, AgreesWithFiniteDifferences) {
  EXPECT_LT(errorOfBlocks(SpringLaw{}, bentAndMoving()), 1e-9);                 // 1.7e-10
  EXPECT_LT(errorOfBlocks(SpringLaw{2e3, 30.0, 0.4}, bentAndMoving()), 1e-9);   // 8.9e-11
  EXPECT_LT(errorOfBlocks(SpringLaw{50.0, 0.0, 1.0}, bentAndMoving()), 1e-9);   // undamped
  EXPECT_LT(errorOfBlocks(SpringLaw{50.0, 10.0, 0.0}, bentAndMoving()), 1e-9);  // no rest length
}

TEST(Jacobian, IsSymmetricWithoutSidewaysApproachOnly) {
  SpringJacobian jacobian(2);
  State state = bentAndMoving();
  computeSpringJacobian(SpringLaw{}, state.values(), jacobian);
  EXPECT_GT(std::abs(jacobian.stiffness(0, 1) - jacobian.stiffness(0, 2)), 0.05);  // 0.06
  EXPECT_EQ(jacobian.damping(0, 1), jacobian.damping(0, 2));
  state.velocities().setZero();
  computeSpringJacobian(SpringLaw{}, state.values(), jacobian);
  EXPECT_NEAR(jacobian.stiffness(0, 1), jacobian.stiffness(0, 2), 1e-13);
}

TEST(Jacobian, SpringWithoutLengthHasNone) {
  SpringJacobian jacobian(2);
  State state(3);
  computeSpringJacobian(SpringLaw{}, state.values(), jacobian);
  EXPECT_EQ(jacobian.stiffness.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(jacobian.damping.cwiseAbs().maxCoeff(), 0.0);
}

}  // namespace
}  // namespace spring_pendulum
