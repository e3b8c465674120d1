#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/verdict_of_run.hpp"

namespace spring_pendulum {
namespace {

using testing::HasSubstr;

State horizontal(Eigen::Index particles) {
  return test::straightLine(particles, 1.0, 0.0);
}

// Which runs have which verdict is recorded in stability_map_test.
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
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    for (const Eigen::Index column : {0, 1, 2, 3}) {
      State state = start;
      state.values()(3, column) = bad;
      Judge judge(chain, start, JudgeOptions{false});
      EXPECT_EQ(judge.judge(0.5, state, 0.0, nullptr).kind, VerdictKind::kDiverged);
      EXPECT_EQ(judge.worst().particle, 4);
      EXPECT_EQ(judge.worst().text,
                "diverged at t = 0.5 s: particle 4 is no longer a finite number");
    }
  }
}

TEST(Verdict, FindsANumberThatIsNotFiniteWithoutSpringsAndGravity) {
  const Chain chain(Eigen::VectorXd::Ones(3), SpringLaw{0.0, 0.0, 0.0}, 0.0);
  State state = horizontal(3);
  Judge judge(chain, state, JudgeOptions{false});
  EXPECT_EQ(judge.judge(0.0, state, 0.0, nullptr).kind, VerdictKind::kNotChecked);
  state.y()[2] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(judge.judge(0.1, state, 0.0, nullptr).kind, VerdictKind::kDiverged);
  EXPECT_EQ(judge.worst().particle, 3);
}

TEST(Verdict, IsDriftIfTheDissipatedEnergyIsNotANumber) {
  const Chain chain(Eigen::VectorXd::Ones(3), SpringLaw{}, 9.81);
  const State start = horizontal(3);
  Judge judge(chain, start, JudgeOptions{true});
  EXPECT_EQ(judge.judge(0.0, start, 0.0, nullptr).kind, VerdictKind::kNotChecked);
  EXPECT_EQ(judge.judge(0.1, start, std::nan(""), nullptr).kind, VerdictKind::kDrift);
}

TEST(Verdict, RemembersTheWorstAndTheFirstTimeOfIt) {
  const Chain chain(Eigen::VectorXd::Ones(3), SpringLaw{}, 9.81);
  const State start = horizontal(3);
  Judge judge(chain, start, JudgeOptions{false});
  judge.judge(0.0, start, 0.0, nullptr);
  State raised = start;
  raised.y()[2] = 0.2;  // 2 J up
  judge.judge(1.0, raised, 0.0, nullptr);
  judge.judge(2.0, raised, 0.0, nullptr);
  EXPECT_EQ(judge.judge(3.0, start, 0.0, nullptr).kind, VerdictKind::kNotChecked);
  EXPECT_EQ(judge.worst().kind, VerdictKind::kGainedEnergy);
  EXPECT_EQ(judge.worst().time, 1.0);
}

TEST(Verdict, IsOkForTheFixedParticleAlone) {
  const Chain chain(Eigen::VectorXd::Ones(1), SpringLaw{}, 9.81);
  Judge judge(chain, State(1), JudgeOptions{false});
  EXPECT_EQ(judge.judge(1.0, State(1), 0.0, nullptr).kind, VerdictKind::kNotChecked);
  EXPECT_EQ(judge.entry().relative_gain, 0.0);
}

}  // namespace
}  // namespace spring_pendulum
