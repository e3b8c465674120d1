#include "simulation/judge.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include "support/scenes.hpp"

namespace spring_pendulum {
namespace {

State horizontal(Eigen::Index particles, double spacing) {
  return test::straightLine(particles, spacing, 0.0);
}

Chain uniform(Eigen::Index particles, const SpringLaw& spring, double gravity) {
  return {Eigen::VectorXd::Ones(particles), spring, gravity};
}

double scaleOf(const Chain& chain, const State& start) {
  return Judge(chain, start, {false}).scale(0.0);
}

TEST(EnergyScale, IsTheDepthOfTheHangingChainForAStartWithoutEnergy) {
  // Two springs carry 2 m g and m g: E_min = -(3 m g L_0 + 5 (m g)²/(2 k_s)).
  const double depth = 3.0 * 9.81 + 5.0 * 9.81 * 9.81 / 100.0;
  const Judge balance(uniform(3, SpringLaw{}, 9.81), horizontal(3, 1.0), {false});
  EXPECT_NEAR(balance.scale(0.0), depth, 1e-12);
  EXPECT_EQ(balance.scale(100.0), balance.scale(0.0));
}

TEST(EnergyScale, AddsTheEnergyOfAStartAboveTheAnchorsLevel) {
  const State stretched = horizontal(3, 3.0);  // 2 k_s (3 - 1)²/2 = 200 J
  const Chain chain = uniform(3, SpringLaw{}, 9.81);
  EXPECT_NEAR(scaleOf(chain, stretched), scaleOf(chain, horizontal(3, 1.0)) + 200.0, 1e-10);
}

TEST(EnergyScale, IsTheSameForGravityUpwards) {
  EXPECT_EQ(scaleOf(uniform(5, SpringLaw{}, -9.81), horizontal(5, 1.0)),
            scaleOf(uniform(5, SpringLaw{}, 9.81), horizontal(5, 1.0)));
}

TEST(EnergyScale, StaysAboveZeroWhereNothingMoves) {
  EXPECT_GT(scaleOf(uniform(3, SpringLaw{}, 0.0), horizontal(3, 1.0)), 0.0);
  EXPECT_GT(scaleOf(uniform(3, {50.0, 1.0, 0.0}, 0.0), horizontal(3, 1.0)), 0.0);
}

TEST(EnergyScale, FollowsTheFreeFallOfAChainWithoutStiffness) {
  const Judge balance(uniform(3, {0.0, 0.0, 1.0}, 10.0), horizontal(3, 1.0), {false});
  EXPECT_DOUBLE_EQ(balance.scale(2.0) - balance.scale(0.0), 2.0 * 100.0 * 4.0 / 2.0);
}

TEST(EnergyScale, RefusesEnergiesBeyondADouble) {
  Eigen::VectorXd masses = Eigen::VectorXd::Constant(3, 1e300);
  EXPECT_THROW(scaleOf(Chain(masses, SpringLaw{}, 9.81), horizontal(3, 1.0)), InputError);
  const SpringLaw stiff{1e300, 0.0, 1.0};
  EXPECT_THROW(scaleOf(uniform(3, stiff, 0.0), horizontal(3, 1e10)), InputError);
  const SpringLaw none{0.0, 0.0, 0.0};
  EXPECT_THROW(scaleOf(uniform(3, none, 1e160), horizontal(3, 1.0)), InputError);
}

TEST(EnergyBalance, ClosesWithTheOrderOfTheMethod) {
  // Halving the step divides the residual by 2^order; measured 2.01 (Euler), 4.10 (Runge-Kutta-2),
  // 15.9 (Runge-Kutta-4).
  const Chain chain = uniform(4, SpringLaw{}, 9.81);
  for (const Method& method : methodTable()) {
    if (!method.hasFixedStep()) continue;
    double residual[2];
    for (const int refined : {0, 1}) {
      State state = horizontal(4, 1.1);
      const Judge balance(chain, state, {true});
      const auto integrator = makeIntegrator(method, chain, {1e-6, true});
      const std::int64_t steps = refined == 0 ? 1000 : 2000;
      integrator->advance(state, 1.0 / static_cast<double>(steps), steps);
      residual[refined] = *balance.balanceOf(1.0, state, integrator->dissipatedEnergy()).residual;
    }
    const double ratio = residual[0] / residual[1];
    const double expected = std::pow(2.0, method.order);
    EXPECT_GT(ratio, 0.9 * expected) << method.name;
    EXPECT_LT(ratio, 1.1 * expected) << method.name;
  }
}

TEST(EnergyBalance, LeavesTheResidualOpenOnlyIfDampingIsNotTracked) {
  const State start = horizontal(3, 1.0);
  EXPECT_FALSE(
      Judge(uniform(3, SpringLaw{}, 9.81), start, {false}).balanceOf(0.0, start, 0.0).residual);
  const auto undamped =
      Judge(uniform(3, {50.0, 0.0, 1.0}, 9.81), start, {false}).balanceOf(0.0, start, 0.0);
  EXPECT_EQ(undamped.dissipated, 0.0);
  EXPECT_EQ(undamped.residual, 0.0);
}

}  // namespace
}  // namespace spring_pendulum
