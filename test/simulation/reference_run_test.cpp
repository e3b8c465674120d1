#include "simulation/reference_run.hpp"

#include <spring_pendulum/model/dynamics.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/precise_motion.hpp"
#include "support/reference.hpp"
#include "support/scenes.hpp"

namespace spring_pendulum {
namespace {

const std::vector<test::KnownMotion> kKnownMotions{{"single_vertical", {1, 2, 5, 10, 20, 50}},
                                                   {"two_masses_45deg", {1, 2, 5, 10, 20, 50}},
                                                   {"horizontal_11", {1, 2, 5, 10, 20, 50}},
                                                   {"horizontal_1000", {1, 2}},
                                                   {"light_100", {1, 5}},
                                                   {"lighter_100", {1, 5}},
                                                   {"alternating_50", {1, 5}},
                                                   {"feather_50", {1}}};

/// Advances to the next frame.
void advance(ReferenceRun& reference, double time_step, std::int64_t steps, double run_work = 0.0) {
  EXPECT_TRUE(reference.advance(time_step, steps));
  reference.measure(run_work);
}

double largestDistance(const State& a, const State& b) {
  return (a.positions() - b.positions()).rowwise().norm().maxCoeff();
}

class ReferenceRunOn : public testing::TestWithParam<test::KnownMotion> {};

INSTANTIATE_TEST_SUITE_P(Scenes, ReferenceRunOn, testing::ValuesIn(kKnownMotions),
                         testing::PrintToStringParamName());

// Measured: the true error is at most 0.2 of the bound, and that at most 1e-8 m.
TEST_P(ReferenceRunOn, StaysWithinItsUncertainty) {
  const test::Scene scene = test::referenceScene(GetParam().scene);
  ReferenceRun reference(scene.chain, scene.start, 1e-6, true);
  int reached = 0;
  for (const int time : GetParam().times) {
    advance(reference, 0.1, 10L * (time - reached));
    reached = time;
    const State exact = test::referenceSolution(GetParam().scene, time);
    EXPECT_LE(largestDistance(*reference.state(), exact), reference.uncertainty()) << time << " s";
    EXPECT_LE(reference.uncertainty(), 5e-8) << time << " s";
  }
}

// A light particle creeps into the first one, at a distance of exp(-50 t) after t seconds. The
// errors of both trajectories have the same direction, and the error is 2.5 times their distance.
TEST(ReferenceRun, StaysWithinItsUncertaintyWhereBothTrajectoriesErrAlike) {
  const Eigen::Vector2d masses{1.0, 1.17e-6};
  State start(2);
  start.x()[1] = -0.483;
  start.y()[1] = 0.252;
  ReferenceRun reference(Chain(masses, {50.0, 1.0, 0.0}, 0.0), start, 1e-8, true);
  advance(reference, 0.1, 10);
  EXPECT_LE(largestDistance(*reference.state(), State(2)), reference.uncertainty());
}

TEST(ReferenceRun, MeasuresTheLargestDistanceOfAParticle) {
  const test::Scene scene = test::horizontalChain("3 particles", 3, 1.0);
  ReferenceRun reference(scene.chain, scene.start);
  advance(reference, 0.1, 5);
  State state = *reference.state();
  EXPECT_EQ(reference.errorOf(state), 0.0);
  state.x()[1] += 3e-3;
  state.y()[1] += 4e-3;
  EXPECT_NEAR(reference.errorOf(state), 5e-3, 1e-15);
  state.y()[2] = std::nan("");
  EXPECT_TRUE(std::isnan(reference.errorOf(state)));
}

TEST(ReferenceRun, HasTheSameBitsHoweverItIsSampled) {
  const test::Scene scene = test::horizontalChain("11 particles", 11, 1.0);
  ReferenceRun seldom(scene.chain, scene.start), often(scene.chain, scene.start);
  advance(seldom, 0.1, 20);
  for (int n = 0; n < 20; ++n) advance(often, 0.1, 1);
  EXPECT_EQ(seldom.state()->values(), often.state()->values());
}

TEST(ReferenceRun, MayCostAsMuchAsTheRun) {
  const test::Scene scene = test::horizontalChain("feather", 50, 1e-6);
  ReferenceRun beside_long(scene.chain, scene.start), beside_short(scene.chain, scene.start);
  while (beside_short.isMeasuring()) {
    advance(beside_short, 0.01, 1);
    advance(beside_long, 0.01, 1, 10.0);
  }
  EXPECT_TRUE(beside_long.isMeasuring());
}

// Perturbations grow 6380 times in 50 s, and 20 times in 10 s.
TEST(ReferenceRun, TellsWhetherTheMotionIsSensitive) {
  const test::Scene scene = test::referenceScene("horizontal_11");
  ReferenceRun reference(scene.chain, scene.start, 1e-6, true);
  advance(reference, 0.1, 100);
  EXPECT_FALSE(reference.isSensitive());
  const test::Scene chaotic = test::horizontalChain("undamped", 11, 1.0, {500.0, 0.0, 1.0});
  ReferenceRun beside_chaos(chaotic.chain, chaotic.start, 1e-6, true);
  advance(beside_chaos, 0.1, 100);
  EXPECT_TRUE(beside_chaos.isMeasuring());
  EXPECT_TRUE(beside_chaos.isSensitive());
}

// Off its line the chain would buckle, but no error of a method leaves the line.
TEST(ReferenceRun, KeepsAChainOnItsLine) {
  const Chain standing(Eigen::Vector3d::Ones(), {50.0, 1.0, 1.0}, 9.81);
  const Chain pressed(Eigen::Vector3d::Ones(), {50.0, 1.0, 1.0}, 0.0);
  ReferenceRun vertical(standing, test::straightLine(3, 0.0, 0.8));
  ReferenceRun horizontal(pressed, test::straightLine(3, 0.8, 0.0));
  for (ReferenceRun* reference : {&vertical, &horizontal}) {
    advance(*reference, 0.1, 200);
    EXPECT_LT(reference->uncertainty(), 1e-9);
  }
}

TEST(ReferenceRun, LeavesOutVeryLongChainsUnlessItIsAskedFor) {
  const test::Scene scene = test::horizontalChain("long", 100'001, 1.0);
  EXPECT_FALSE(ReferenceRun(scene.chain, scene.start).isMeasuring());
  EXPECT_TRUE(ReferenceRun(scene.chain, scene.start, 0.0, true).isMeasuring());
}

// Rounding errors of two trajectories with similar steps do not cancel out, so the start of the companion
// is moved. Measured: at most 0.02 of the uncertainty; otherwise up to 38 times the uncertainty.
TEST(ReferenceRun, StaysWithinItsUncertaintyBesideChaoticMotions) {
  for (const unsigned seed : {18U, 30U, 57U, 99U}) {
    SCOPED_TRACE(seed);
    const test::Scene scene = test::chaoticScene(seed);
    test::PreciseMotion exact(scene);
    ReferenceRun reference(scene.chain, scene.start, 1e-9, true);
    int frames = 0;
    for (; frames < 12; ++frames) {
      advance(reference, 0.5, 1);
      if (!reference.isMeasuring()) break;
      exact.advance(0.5);
      EXPECT_LE(exact.errorOf(*reference.state()), reference.uncertainty()) << frames;
    }
    EXPECT_GE(frames, 5);
  }
}

// The cost is compared with its limit at frames, however many parts they have.
TEST(ReferenceRun, StopsAtTheSameFrameForEveryNumberOfParts) {
  const test::Scene scene = test::horizontalChain("feather", 50, 1e-6);
  std::vector<int> frames;
  for (const int parts : {1, 2, 4, 64}) {
    ReferenceRun reference(scene.chain, scene.start);
    int frame = 0;
    for (; reference.isMeasuring(); ++frame) {
      for (int part = 0; part < parts; ++part) reference.advance(0.1 / parts, 1);
      EXPECT_TRUE(reference.isMeasuring());
      reference.measure(0.0);
    }
    EXPECT_EQ(reference.reason(), "a reference run would cost more than the run itself");
    EXPECT_TRUE(std::isnan(reference.errorOf(scene.start)));
    frames.push_back(frame);
  }
  EXPECT_GT(frames[0], 1);
  EXPECT_EQ(frames, std::vector<int>(4, frames[0]));
}

TEST(ChainLength, IsTheSumOfRestLengthsOrATenthOfTheStart) {
  const test::Scene line = test::horizontalChain("line", 11, 1.0);
  EXPECT_DOUBLE_EQ(chainLength(line.chain, line.start), 10.0);
  const test::Scene loose = test::horizontalChain("loose", 11, 1.0, {50.0, 1.0, 0.0});
  EXPECT_DOUBLE_EQ(chainLength(loose.chain, loose.start), 1.0);
  const test::Scene anchor{"anchor", Chain(Eigen::VectorXd::Ones(1), {}, 9.81), State(1)};
  EXPECT_EQ(chainLength(anchor.chain, anchor.start), 0.0);
}

}  // namespace
}  // namespace spring_pendulum
