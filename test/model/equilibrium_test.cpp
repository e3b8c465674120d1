#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/scenes.hpp"

namespace spring_pendulum {
namespace {

using testing::HasSubstr;

double largestMove(const Chain& chain, const State& start, double duration) {
  State state = start;
  makeIntegrator("Taylor-12", chain, {1e-10})->advance(state, duration, 1);
  return (state.positions() - start.positions()).cwiseAbs().maxCoeff();
}

TEST(Equilibrium, HangsStraightFromOneEnd) {
  const test::Scene scene = test::horizontalChain("horizontal", 11, 1.0);
  const State state = equilibrium(scene.chain, scene.start);
  const State expected = test::hangingAtRest(scene.chain);
  EXPECT_LE((state.values() - expected.values()).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LE(largestMove(scene.chain, state, 20.0), 1e-11);  // 2e-14
}

TEST(Equilibrium, StaysAtRestBetweenHeldParticles) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Index size = 3 + static_cast<Eigen::Index>(40.0 * uniform(random));
    Eigen::VectorXd masses(size);
    for (Eigen::Index i = 0; i < size; ++i) masses[i] = std::pow(10.0, 2.0 * uniform(random) - 1.0);
    const SpringLaw spring{std::pow(10.0, 1.0 + 3.0 * uniform(random)), 1.0, 0.3};
    // Very slack chains can rest only with compressed springs.
    State state =
        test::straightLine(size, 0.5 * uniform(random) + 0.2, 0.2 * uniform(random) - 0.1);
    Drive drive{{{size - 1, {}}}, {}};
    if (trial % 3 == 1 && size > 5) drive.held.push_back({size / 2, {}});
    if (trial % 3 == 2 && size > 5) drive.forces.push_back({size / 2, {4.0, -2.0}});
    const Chain chain = Chain(masses, spring, 9.81).drivenBy(drive);
    const State rest = equilibrium(chain, state);
    EXPECT_LE(std::abs(rest.x()[size - 1] - state.x()[size - 1]), 1e-12);
    EXPECT_LE(largestMove(chain, rest, 0.5), 1e-9) << trial;  // 4e-11
  }
}

// The slack cable turns over within one short spring.
TEST(Equilibrium, FindsTheRestOfSlackStiffCables) {
  struct Case {
    double left, right;  ///< masses, kg
    double stiffness, x, y;
  };
  for (const Case& c : {Case{2.0, 2.4, 1e3, 0.9, -0.6},
                        {0.3, 2.9, 1e4, 1.1, -0.6},
                        {2.7, 1.9, 1e6, 0.7, -0.8},
                        {2.5, 1.8, 1e4, 0.7, 0.8}}) {
    const Eigen::Vector4d masses(1.0, c.left, c.right, 1.0);
    const Chain chain = Chain(masses, {c.stiffness, 1.0, 1.0}, 9.81).drivenBy({{{3, {}}}, {}});
    State state(4);
    state.x().setLinSpaced(0.0, c.x);
    state.y().setLinSpaced(0.0, c.y);
    EXPECT_LE(largestMove(chain, equilibrium(chain, state), 0.1), 1e-9) << c.stiffness;
  }
}

TEST(Equilibrium, RefusesWhatCannotRest) {
  const State start = test::straightLine(4, 0.1, 0.0);
  const Chain soft(Eigen::VectorXd::Ones(4), SpringLaw{0.0, 1.0, 1.0}, 9.81);
  EXPECT_THROW(equilibrium(soft, start), InputError);
  EXPECT_THROW(equilibrium(soft, State(3)), InputError);
  const Chain weightless =
      Chain(Eigen::VectorXd::Ones(4), SpringLaw{}, 0.0).drivenBy({{{3, {}}}, {}});
  EXPECT_THROW(equilibrium(weightless, start), InputError);
  const Chain point(Eigen::VectorXd::Ones(4), SpringLaw{50.0, 1.0, 0.0}, 0.0);
  EXPECT_THROW(equilibrium(point, start), InputError);
  EXPECT_NO_THROW(equilibrium(point.drivenBy({{{3, {}}}, {}}), start));
  EXPECT_THROW(equilibrium(point.drivenBy({{{3, {}}}, {}}), State(4)), InputError);
  EXPECT_EQ(equilibrium(Chain(Eigen::VectorXd::Ones(1), SpringLaw{}, 9.81), State(1)).size(), 1);
  const Chain softest(Eigen::VectorXd::Ones(4), SpringLaw{1e-320, 1.0, 1.0}, 9.81);
  try {
    equilibrium(softest, start);
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("stiffness must be larger"));
  }
}

}  // namespace
}  // namespace spring_pendulum
