// Verdicts, and the energy scale and balance that they rest on.
#include "simulation/judge.hpp"

#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/verdict_of_run.hpp"

namespace spring_pendulum {
namespace {

using testing::HasSubstr;

State horizontal(Eigen::Index particles, double spacing = 1.0) {
  return test::straightLine(particles, spacing, 0.0);
}

Chain uniform(Eigen::Index particles, const SpringLaw& spring, double gravity) {
  return {Eigen::VectorXd::Ones(particles), spring, gravity};
}

TEST(Verdict, IsDivergedWhileAllIsFinite) {
  const test::Scene light = test::horizontalChain("", 11, 0.01);
  const Verdict verdict = test::verdictOfRun(light, findMethod("Runge-Kutta-4"), 0.01, 5.0, true);
  EXPECT_EQ(verdict.kind, VerdictKind::kDiverged);
  EXPECT_THAT(verdict.text, HasSubstr("diverged at t = 0.3 s: energy up by "));
  EXPECT_GE(verdict.particle, 2);
  EXPECT_LE(verdict.particle, 11);
}

TEST(Verdict, NamesTheFirstParticleThatIsNotFinite) {
  const Chain chain(Eigen::VectorXd::Ones(5), SpringLaw{}, 9.81);
  const State start = horizontal(5);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {std::nan(""), infinity, -infinity})
    for (const Eigen::Index column : {0, 1, 2, 3}) {
      State state = start;
      state.values()(3, column) = bad;
      Judge judge(chain, start, JudgeOptions{false});
      EXPECT_EQ(judge.judge(0.5, state, 0.0, nullptr).kind, VerdictKind::kDiverged);
      EXPECT_EQ(judge.worst().particle, 4);
      EXPECT_THAT(judge.worst().text, HasSubstr("0.5 s: particle 4 is no longer a finite number"));
    }
}

TEST(Verdict, FindsANumberThatIsNotFiniteWithoutSpringsAndGravity) {
  State state = horizontal(3);
  Judge judge(uniform(3, {0.0, 0.0, 0.0}, 0.0), state, {false});
  EXPECT_EQ(judge.judge(0.0, state, 0.0, nullptr).kind, VerdictKind::kNotChecked);
  state.y()[2] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(judge.judge(0.1, state, 0.0, nullptr).kind, VerdictKind::kDiverged);
  EXPECT_EQ(judge.worst().particle, 3);
}

TEST(Verdict, IsDriftIfTheDissipatedEnergyIsNotANumber) {
  const State start = horizontal(3);
  Judge judge(uniform(3, SpringLaw{}, 9.81), start, {true});
  EXPECT_EQ(judge.judge(0.0, start, 0.0, nullptr).kind, VerdictKind::kNotChecked);
  EXPECT_EQ(judge.judge(0.1, start, std::nan(""), nullptr).kind, VerdictKind::kDrift);
}

TEST(Verdict, RemembersTheWorstAndTheFirstTimeOfIt) {
  const State start = horizontal(3);
  Judge judge(uniform(3, SpringLaw{}, 9.81), start, {false});
  judge.judge(0.0, start, 0.0, nullptr);
  State raised = start;
  raised.y()[2] = 0.2;  // 2 J up
  judge.judge(1.0, raised, 0.0, nullptr);
  judge.judge(2.0, raised, 0.0, nullptr);
  EXPECT_FALSE(isBad(judge.judge(3.0, start, 0.0, nullptr).kind));
  EXPECT_EQ(judge.worst().kind, VerdictKind::kGainedEnergy);
  EXPECT_EQ(judge.worst().time, 1.0);
}

double scaleOf(const Chain& chain, const State& start) {
  return Judge(chain, start, {false}).scale(0.0);
}

TEST(EnergyScale, IsTheDepthOfTheHangingChainForAStartWithoutEnergy) {
  // Two springs carry 2 m g and m g: E_min = -(3 m g L_0 + 5 (m g)²/(2 k_s)).
  const double depth = 3.0 * 9.81 + 5.0 * 9.81 * 9.81 / 100.0;
  EXPECT_NEAR(scaleOf(uniform(3, SpringLaw{}, 9.81), horizontal(3)), depth, 1e-12);
}

TEST(EnergyScale, KnowsStretchedWeightlessAndFallingChains) {
  const State stretched = horizontal(3, 3.0);  // 2 k_s (3 - 1)²/2 = 200 J
  const double scale = scaleOf(uniform(3, SpringLaw{}, 9.81), horizontal(3));
  EXPECT_NEAR(scaleOf(uniform(3, SpringLaw{}, 9.81), stretched), scale + 200.0, 1e-10);
  EXPECT_EQ(scaleOf(uniform(3, SpringLaw{}, -9.81), horizontal(3)), scale);
  EXPECT_GT(scaleOf(uniform(3, {50.0, 1.0, 0.0}, 0.0), horizontal(3)), 0.0);
  const Judge balance(uniform(3, {0.0, 0.0, 1.0}, 10.0), horizontal(3), {false});
  EXPECT_DOUBLE_EQ(balance.scale(2.0) - balance.scale(0.0), 2.0 * 100.0 * 4.0 / 2.0);
}

TEST(EnergyScale, ForgetsForcesAndAChainThatHasNotMoved) {
  const Chain chain = uniform(3, SpringLaw{}, 9.81), slack = uniform(3, {0.0, 0.0, 1.0}, 9.81);
  const State start = horizontal(3), far = horizontal(3, 1000.0);
  Judge judge(chain, start, {false});
  const double scale = judge.scale(0.0);
  judge.change(chain.drivenBy({{}, {{1, {200.0, 0.0}}}}), start, start, {false}, 0.0, true);
  judge.change(chain, far, far, {false}, 0.0, true);  // far by an error, not by a holder
  EXPECT_EQ(judge.scale(0.0), scale);
  for (const bool has_moved : {false, true}) {
    double supplied = judge.change(slack, start, far, {false}, 0.0, true);
    supplied = judge.change(uniform(3, {1e6, 0.0, 1.0}, 0.0), far, far, {false}, supplied, false);
    judge.change(chain, far, start, {false}, supplied, has_moved);
    EXPECT_EQ(judge.scale(100.0), judge.scale(0.0));
    EXPECT_EQ(judge.scale(0.0) > scale, has_moved);
    EXPECT_EQ(judge.balanceOf(0.0, start, 0.0, 1.0).relative_gain > -1e-3 / scale, has_moved);
  }
}

TEST(EnergyScale, RefusesEnergiesBeyondADouble) {
  Eigen::VectorXd masses = Eigen::VectorXd::Constant(3, 1e300);
  EXPECT_THROW(scaleOf(Chain(masses, SpringLaw{}, 9.81), horizontal(3)), InputError);
  const SpringLaw stiff{1e300, 0.0, 1.0};
  EXPECT_THROW(scaleOf(uniform(3, stiff, 0.0), horizontal(3, 1e10)), InputError);
  EXPECT_THROW(scaleOf(uniform(3, {0.0, 0.0, 0.0}, 1e160), horizontal(3)), InputError);
}

TEST(EnergyBalance, ClosesWithTheOrderOfTheMethod) {
  // Halving the step divides the residual by 2^order; measured 2.01, 4.10 and 15.9 for Runge-Kutta-4.
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
  const State start = horizontal(3);
  EXPECT_FALSE(
      Judge(uniform(3, SpringLaw{}, 9.81), start, {false}).balanceOf(0.0, start, 0.0).residual);
  const auto undamped =
      Judge(uniform(3, {50.0, 0.0, 1.0}, 9.81), start, {false}).balanceOf(0.0, start, 0.0);
  EXPECT_EQ(undamped.dissipated, 0.0);
  EXPECT_EQ(undamped.residual, 0.0);
}

}  // namespace
}  // namespace spring_pendulum
