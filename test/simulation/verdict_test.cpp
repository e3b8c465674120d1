#include "simulation/judge.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace spring_pendulum {
namespace {

using testing::HasSubstr;

State horizontal(Eigen::Index particles) {
  State state(particles);
  for (Eigen::Index i = 0; i < particles; ++i) state.x()[i] = static_cast<double>(i);
  return state;
}

struct Outcome {
  Verdict verdict;
  int frames;  ///< judged before the motion diverged, or all
};

/// Runs a horizontal chain as the exercise does: 500 frames of 10 steps.
Outcome run(const std::string& method, Eigen::Index particles, double mass, double time_step) {
  const Chain chain(Eigen::VectorXd::Constant(particles, mass), SpringLaw{}, 9.81);
  State state = horizontal(particles);
  const auto integrator = makeIntegrator(method, chain, {1e-6, true});
  Judge judge(chain, state, JudgeOptions{true});
  for (int frame = 0; frame < 500; ++frame) {
    if (frame > 0) integrator->advance(state, time_step, 10);
    const double time = time_step * 10.0 * frame;
    if (judge.judge(time, state, integrator->dissipatedEnergy(), nullptr).kind ==
        VerdictKind::kDiverged) {
      return {judge.worst(), frame};
    }
  }
  return {judge.worst(), 500};
}

TEST(Verdict, RungeKutta4OnTheExerciseIsOk) {
  EXPECT_EQ(run("Runge-Kutta-4", 6, 1.0, 0.01).verdict.text, "not checked: no reference run");
}

TEST(Verdict, EulerBringsSixParticlesToTheEndWithEnergyGained) {
  const Outcome outcome = run("Euler", 6, 1.0, 0.01);
  EXPECT_EQ(outcome.frames, 500);
  EXPECT_EQ(outcome.verdict.kind, VerdictKind::kGainedEnergy);  // up to 10 % of the scale
  EXPECT_THAT(outcome.verdict.text, HasSubstr("gained energy: "));
}

TEST(Verdict, EulerDivergesOnElevenParticles) {
  const Outcome outcome = run("Euler", 11, 1.0, 0.01);
  EXPECT_EQ(outcome.verdict.kind, VerdictKind::kDiverged);
  EXPECT_EQ(outcome.frames, 150);  // long before a number is not finite
}

TEST(Verdict, RungeKutta4BeyondItsStabilityLimitDivergesWhileAllIsFinite) {
  const Outcome outcome = run("Runge-Kutta-4", 11, 0.01, 0.01);
  EXPECT_EQ(outcome.verdict.kind, VerdictKind::kDiverged);
  EXPECT_EQ(outcome.frames, 3);
  EXPECT_THAT(outcome.verdict.text, HasSubstr("diverged at t = 0.3 s: energy up by "));
  EXPECT_GE(outcome.verdict.particle, 2);
  EXPECT_LE(outcome.verdict.particle, 11);
}

TEST(Verdict, DriftIsFoundByTheEnergyBalanceAlone) {
  // One light particle just inside the stability limit: no gain, but a wrong balance (1.1 %).
  EXPECT_EQ(run("Runge-Kutta-4", 2, 0.01, 0.01).verdict.kind, VerdictKind::kDrift);
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
}

TEST(Verdict, KindsHaveTheNamesUsersRead) {
  EXPECT_EQ(toString(VerdictKind::kOk), "ok");
  EXPECT_EQ(toString(VerdictKind::kDrift), "drift");
  EXPECT_EQ(toString(VerdictKind::kGainedEnergy), "gained energy");
  EXPECT_EQ(toString(VerdictKind::kDiverged), "diverged");
}

}  // namespace
}  // namespace spring_pendulum
