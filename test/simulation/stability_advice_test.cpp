#include "model/chain_modes.hpp"
#include "simulation/mode_response.hpp"
#include <spring_pendulum/simulation/stability_advice.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/verdict_of_run.hpp"

namespace spring_pendulum {
namespace {

using test::Scene;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kDuration = 5.0;  ///< s

/// Whether the verdict on a run of 5 s is better than `gained energy`. The energy that the
/// symplectic Euler method shows sways with its first-order error, however stable it is: there it
/// is the divergence that has to be foretold (measured: 1.000 to 1.11 times the advice; 2.0 where
/// one spring hangs at rest).
bool holds(const Scene& scene, const Method& method, double time_step) {
  const auto kind =
      method.name == "Semi-Implicit-Euler" ? VerdictKind::kDiverged : VerdictKind::kGainedEnergy;
  return test::verdictOfRun(scene, method, time_step, kDuration, false, kind).kind < kind;
}

/// Runge-Kutta methods with a region of stability on the imaginary axis, whose advice is meant to
/// be exact. That for the symplectic ones is safe, but up to 1.5 times too small for a single
/// spring.
bool isSharp(const Method& method) {
  return method.tableau != nullptr && ModeResponse(method, 0.0).growthRate(0.1) == 0.0;
}

template <typename Visitor>
void forEachSceneAndMethod(const Visitor& visitor) {
  for (const Scene& scene : test::stabilityScenes()) {
    for (const Method& method : methodTable()) {
      if (method.control != StepControl::kFixed) continue;
      SCOPED_TRACE(std::string(method.name) + ", " + scene.name);
      const StabilityAdvice advice =
          adviseOnStability(method, scene.chain, scene.start, 0.01, kDuration);
      if (kDuration / advice.largestStep() > 1e5) continue;  // too long for a test
      visitor(scene, method, advice);
    }
  }
}

TEST(StabilityAdvice, IsNeverMoreThanFivePercentTooLarge) {
  int cases = 0;
  forEachSceneAndMethod([&](const Scene& scene, const Method& method, const auto& advice) {
    if (std::isinf(advice.largestStep())) return;
    ++cases;
    EXPECT_TRUE(holds(scene, method, advice.largestStep() / 1.05));
  });
  EXPECT_GE(cases, 60);
}

TEST(StabilityAdvice, IsAtMostFifteenPercentTooSmallWhereSpringsDecide) {
  int cases = 0;
  forEachSceneAndMethod([&](const Scene& scene, const Method& method, const auto& advice) {
    const bool stiff = advice.spring_step < 0.2 * advice.swing_step;
    const double ratio = dampingRatio(scene.chain.spring(), largestSpringMode(scene.chain));
    if (!isSharp(method) && !(stiff && ratio > 0.05)) return;
    if (std::isinf(advice.largestStep())) return;
    ++cases;
    EXPECT_FALSE(holds(scene, method, advice.largestStep() / 0.85));
  });
  EXPECT_GE(cases, 30);
}

TEST(StabilityAdvice, KnowsNoLimitWithoutSprings) {
  const Chain chain(Eigen::VectorXd::Ones(1), SpringLaw{}, 9.81);
  for (const Method& method : methodTable()) {
    EXPECT_TRUE(std::isinf(adviseOnStability(method, chain, State(1), 0.01, 5.0).largestStep()));
  }
}

TEST(StabilityAdvice, IsDefinedInEveryCornerOfTheParameters) {
  for (const double stiffness : {0.0, 1e-30, 50.0, 1e30}) {
    for (const double damping : {0.0, 1e-30, 1.0, 1e30}) {
      for (const double gravity : {0.0, -9.81, 1e5}) {
        const Scene scene =
            test::horizontalChain("corner", 4, 1.0, {stiffness, damping, 1.0}, gravity);
        for (const char* name : {"Euler", "Runge-Kutta-4"}) {
          const auto advice =
              adviseOnStability(findMethod(name), scene.chain, scene.start, 0.01, 50.0);
          EXPECT_GE(advice.largestStep(), 0.0) << stiffness << " " << damping << " " << gravity;
          EXPECT_FALSE(std::isnan(advice.swing_growth));
        }
      }
    }
  }
}

TEST(StabilityAdvice, TellsOfEulersSwingThatGrows) {
  const Scene scene = test::horizontalChain("exercise", 11, 1.0);
  const auto advice = adviseOnStability(findMethod("Euler"), scene.chain, scene.start, 0.01, 49.9);
  const double swing = 0.794;  // rad/s, growth exp(h ω² T)
  EXPECT_NEAR(advice.swing_growth, std::exp(0.01 * swing * swing * 49.9), 0.01);
}

TEST(StabilityAdvice, WarnsOfARunThatWillNotHoldAndNamesAMethodThatDoes) {
  const Scene light = test::horizontalChain("light", 11, 0.01);
  Scenario scenario;
  EXPECT_THAT(warnOfInstability(light.chain, light.start, scenario),
              HasSubstr("a step of 0.01 s is too large for the springs: Runge-Kutta-4 bears steps "
                        "up to 0.00838 s here"));
  const Scene exercise = test::horizontalChain("exercise", 6, 1.0);
  EXPECT_THAT(warnOfInstability(exercise.chain, exercise.start, scenario), IsEmpty());
  scenario.method = "Runge-Kutta-2";
  EXPECT_THAT(warnOfInstability(exercise.chain, exercise.start, scenario), IsEmpty());
  scenario.method = "Euler";
  EXPECT_THAT(warnOfInstability(exercise.chain, exercise.start, scenario),
              HasSubstr("lets the swinging gain energy at every step size"));
  const std::string name = methodThatHolds(exercise.chain, exercise.start, scenario);
  ASSERT_FALSE(name.empty());
  EXPECT_THAT(remedyForDivergence(exercise.chain, exercise.start, scenario), HasSubstr(name));
  EXPECT_TRUE(holds(exercise, findMethod(name), scenario.time_step));
}

TEST(StabilityAdvice, DescribesWhatHolds) {
  const Scene scene = test::horizontalChain("exercise", 11, 1.0);
  const std::string text = describeStability(scene.chain, scene.start, Scenario{});
  EXPECT_EQ(text,
            "fastest spring mode 14 1/s, fastest swing 10.6 rad/s, slow swing 0.794 rad/s\n"
            "Runge-Kutta-4: the springs bear steps up to 0.202 s; a step of 0.01 s holds\n");
}

TEST(StabilityAdvice, DescribesWhatToDoWithAStepThatDoesNotHold) {
  const Scene light = test::horizontalChain("light", 11, 0.001);
  EXPECT_THAT(describeStability(light.chain, light.start, Scenario{}),
              HasSubstr("\na step of 0.01 s is too large for the springs: Runge-Kutta-4 bears "
                        "steps up to 0.000721 s here; Auto holds, which chooses its own steps\n"));
  Scenario coarse;
  coarse.time_step = 0.0075;
  coarse.method = "Runge-Kutta-2";
  const Scene heavier = test::horizontalChain("heavier", 11, 0.01);
  EXPECT_THAT(describeStability(heavier.chain, heavier.start, coarse),
              HasSubstr("here; Runge-Kutta-4 holds with 0.0075 s\n"));
}

TEST(StabilityAdvice, LeavesTheStepToTheMethodsThatChooseIt) {
  const Scene scene = test::horizontalChain("exercise", 11, 1.0);
  Scenario scenario;
  scenario.method = "Taylor-8";
  EXPECT_THAT(describeStability(scene.chain, scene.start, scenario),
              EndsWith("\nTaylor-8 chooses its own steps\n"));
  EXPECT_EQ(warnOfInstability(scene.chain, scene.start, scenario), "");
  EXPECT_EQ(methodThatHolds(scene.chain, scene.start, scenario), "Auto");
  EXPECT_EQ(remedyForDivergence(scene.chain, scene.start, scenario),
            "a tolerance below 1e-06 m may hold; Auto holds, which chooses its own steps");
  scenario.method = "Auto";
  EXPECT_EQ(methodThatHolds(scene.chain, scene.start, scenario), "");
  EXPECT_EQ(remedyForDivergence(scene.chain, scene.start, scenario),
            "a tolerance below 1e-06 m may hold");
}

}  // namespace
}  // namespace spring_pendulum
