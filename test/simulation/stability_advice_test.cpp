#include "simulation/advice/trial.hpp"
#include <spring_pendulum/simulation/reference_run.hpp>
#include <spring_pendulum/simulation/stability_advice.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>
#include <string>

#include "support/random_scenes.hpp"
#include "support/verdict_of_run.hpp"

namespace spring_pendulum {
namespace {

using test::Scene;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kDuration = 5.0;       // s
constexpr double kFrameInterval = 0.1;  // s

bool isStable(const Scene& scene, const Method& method, double step) {
  const auto kind = VerdictKind::kGainedEnergy;
  return test::verdictOfRun(scene, method, step, kDuration, true, kind).kind < kind;
}

template <typename Visitor>
void forEachFixedStepMethod(const Visitor& visitor) {
  for (const Method& method : methodTable()) {
    if (!method.hasFixedStep()) continue;
    SCOPED_TRACE(std::string(method.name));
    visitor(method);
  }
}

TEST(LargestPassingStep, IsWithinOnePercentBelowTheLimit) {
  for (const double limit : {2e-4, 0.0099, 0.0101, 0.3, 7.0}) {
    int tries = 0;
    const double step = largestPassingStep(0.01, 1e-5, 10.0, [&](double s) {
      ++tries;
      return s <= limit;
    });
    EXPECT_LE(step, limit);
    EXPECT_GT(1.0101 * step, limit);
    EXPECT_LE(tries, 70) << limit;
  }
}

TEST(LargestPassingStep, LiesBelowAGapAndAboveNone) {
  // From 0.05 to 0.0525 s a step fails, and from 0.06 s on.
  const auto has_gap = [](double s) { return s < 0.06 && !(s > 0.05 && s < 0.0525); };
  const double step = largestPassingStep(0.01, 1e-5, 10.0, has_gap);
  EXPECT_GT(1.0101 * step, 0.05);
  EXPECT_LE(step, 0.05);
  EXPECT_EQ(largestPassingStep(0.01, 1e-5, 10.0, [](double) { return false; }), 0.0);
  EXPECT_TRUE(std::isinf(largestPassingStep(0.01, 1e-5, 10.0, [](double) { return true; })));
  EXPECT_EQ(largestPassingStep(0.01, 2.0, 1.0, [](double) { return true; }), 0.0);
}

TEST(StabilityAdvice, LargestStableStepIsThatOfRealRuns) {
  for (const unsigned seed : {1U, 6U, 14U, 18U, 29U}) {
    const Scene scene = test::randomScene(seed);
    SCOPED_TRACE(scene.name);
    forEachFixedStepMethod([&](const Method& method) {
      const double step =
          findStepLimits(method, scene.chain, scene.start, 0.01, kDuration, kFrameInterval).stable;
      ASSERT_GT(step, 0.0);
      EXPECT_TRUE(isStable(scene, method, 0.9 * step)) << step;
      EXPECT_TRUE(isStable(scene, method, 0.95 * step)) << step;
      EXPECT_FALSE(isStable(scene, method, 1.05 * step) && isStable(scene, method, 1.1 * step))
          << step;
    });
  }
}

TEST(StabilityAdvice, LargestAccurateStepKeepsOnePercentOfTheLength) {
  const Scene scene = test::horizontalChain("", 6, 1.0);
  const double allowed = 0.01 * chainLength(scene.chain, scene.start);
  const TrialBench bench(scene.chain, scene.start, kDuration, kFrameInterval);
  forEachFixedStepMethod([&](const Method& method) {
    const StepLimits limits =
        findStepLimits(method, scene.chain, scene.start, 0.01, kDuration, kFrameInterval);
    ASSERT_GT(limits.accurate, 0.0);
    EXPECT_LE(limits.accurate, limits.stable);
    EXPECT_LE(bench.run(method, limits.accurate, true).position_error.largest, allowed);
    EXPECT_GT(bench.run(method, 1.5 * limits.accurate, true).position_error.largest, allowed);
  });
}

TEST(StabilityAdvice, LinearLimitIsStable) {
  int cases = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    const Scene scene = test::randomScene(seed);
    SCOPED_TRACE(scene.name);
    forEachFixedStepMethod([&](const Method& method) {
      const double step = linearStepLimit(method, scene.chain, kDuration);
      if (kDuration / step > 1e5) return;
      ++cases;
      // The energy of the symplectic Euler method sways with its first-order error, however stable.
      const auto kind = method.name == "Semi-Implicit-Euler" ? VerdictKind::kDiverged
                                                             : VerdictKind::kGainedEnergy;
      EXPECT_LT(test::verdictOfRun(scene, method, step, kDuration, true, kind).kind, kind) << step;
    });
  }
  EXPECT_GE(cases, 90);
}

TEST(StabilityAdvice, LinearLimitIsDefinedInEveryCornerOfTheParameters) {
  const Chain fixed(Eigen::VectorXd::Ones(1), SpringLaw{}, 9.81);
  for (const Method& method : methodTable()) {
    EXPECT_TRUE(std::isinf(linearStepLimit(method, fixed, kDuration))) << method.name;
  }
  for (const double stiffness : {0.0, 1e-30, 50.0, 1e30}) {
    for (const double damping : {0.0, 1e-30, 1.0, 1e30}) {
      const Chain chain(Eigen::VectorXd::Ones(4), {stiffness, damping, 1.0}, 9.81);
      forEachFixedStepMethod([&](const Method& method) {
        EXPECT_GE(linearStepLimit(method, chain, kDuration), 0.0) << stiffness << " " << damping;
      });
    }
  }
}

TEST(StabilityAdvice, CheckReportsTheVeryRun) {
  const Scene scene = test::horizontalChain("", 11, 1.0);
  Scenario scenario;
  scenario.frames = 51;
  const std::string text = describeStability(scene.chain, scene.start, scenario);
  // 5.93e-6 m is known independently for the largest coordinate.
  EXPECT_THAT(text, StartsWith("Runge-Kutta-4 with a step size of 0.01 s over 5 s: ok\nlargest "
                               "position error 6.4e-06 m at t = 4.7 s, largest energy error "));
  EXPECT_THAT(text, HasSubstr("\nlargest stable step size: 0.2"));
  EXPECT_THAT(text, HasSubstr("\nlargest accurate step size: 0.1"));
}

TEST(StabilityAdvice, CheckFindsAMethodForTheWantedError) {
  const Scene scene = test::horizontalChain("", 6, 1.0);
  Scenario scenario;
  scenario.method = findMethod("Taylor-8");
  scenario.frames = 51;
  scenario.wanted_error = 1e-6;
  EXPECT_THAT(
      describeStability(scene.chain, scene.start, scenario),
      ContainsRegex("position error of at most 1e-06 m: Taylor-[0-9]+ with a tolerance of 1e-0"));
}

TEST(StabilityAdvice, TheMethodFoundKeepsTheWantedError) {
  for (const unsigned seed : {1U, 14U, 37U, 59U}) {
    const Scene scene = test::randomScene(seed);
    Scenario scenario;
    scenario.method = findMethod("Auto");
    scenario.frames = 51;
    scenario.wanted_error = 1e-2;
    const std::string text = describeStability(scene.chain, scene.start, scenario);
    std::smatch found;
    const std::regex advice(" m: ([A-Za-z0-9-]+) with a [a-z ]+ of ([0-9.e-]+) ");
    ASSERT_TRUE(std::regex_search(text, found, advice)) << text;
    const TrialBench bench(scene.chain, scene.start, kDuration, kFrameInterval);
    for (const double share : {1.0, 0.95, 0.9}) {
      const Trial trial = bench.run(findMethod(found.str(1)), share * std::stod(found[2]), true);
      EXPECT_TRUE(trial.measured) << scene.name;
      EXPECT_LE(trial.position_error.largest, scenario.wanted_error) << scene.name << ": " << text;
    }
  }
}

TEST(StabilityAdvice, CheckSaysWhatIsTooLargeToTry) {
  const Scene scene = test::horizontalChain("", 10000, 1.0);
  EXPECT_THAT(
      describeStability(scene.chain, scene.start, Scenario{}),
      StartsWith("Runge-Kutta-4: too many particles and steps to try; linear estimate of the "
                 "largest stable step size: 0."));
}

// The reference run reaches 14 s.
TEST(StabilityAdvice, CheckSaysThatAccuracyWouldTakeTooLongToJudge) {
  const Eigen::Vector4d masses{1.0, 1.0, 1e-4, 1.0};
  const Chain chain(masses, {50.0, 1.0, 1.0}, 9.81);
  Scenario scenario;
  scenario.frames = 201;
  scenario.wanted_error = 1e-3;
  EXPECT_THAT(describeStability(chain, test::straightLine(4, 1.0, 0.0), scenario),
              ContainsRegex("stable step size: 0.0001.* s\nlargest accurate step size: unknown, as "
                            "a reference run would take too long\nposition error of at most 0.001 "
                            "m: unknown, as a reference run would take too long\n"));
}

TEST(StabilityAdvice, RemedyNamesAStepThatIsStable) {
  const Scene light = test::horizontalChain("", 11, 0.001);
  const std::string text = remedyForDivergence(light.chain, light.start, Scenario{});
  const std::string before = "largest stable step for Runge-Kutta-4: ";
  ASSERT_THAT(text, StartsWith(before));
  EXPECT_TRUE(isStable(light, findMethod("Runge-Kutta-4"), std::stod(text.substr(before.size()))));
  Scenario controlled;
  controlled.method = findMethod("Auto");
  EXPECT_EQ(remedyForDivergence(light.chain, light.start, controlled),
            "try a tolerance below 1e-06 m");
}

/// How much the amplitude of q'' + damping q' + stiffness q = 0 has grown after 2,000 steps.
double growth(const Method& method, double stiffness, double damping, double step) {
  const Chain chain(Eigen::Vector2d::Ones(), {stiffness, damping, 1.0}, 0.0);
  State state(2);
  state.x()[1] = 1.0;
  state.vx()[1] = 0x1p-20;
  makeIntegrator(method, chain)->advance(state, step, 2000);
  return std::hypot(stiffness * (state.x()[1] - 1.0), state.vx()[1]) / 0x1p-20;
}

TEST(MethodTable, StabilityLimitsLieOnTheBorder) {
  forEachFixedStepMethod([](const Method& method) {
    EXPECT_LT(growth(method, 0.0, 1.0, 0.99 * method.real_stability_limit), 1.0);
    EXPECT_GT(growth(method, 0.0, 1.0, 1.01 * method.real_stability_limit), 10.0);
    const double limit = method.imaginary_stability_limit;
    if (limit > 0.0) {
      EXPECT_LT(growth(method, 1.0, 0.0, 0.98 * limit), 11.0);       // Verlet: 1/sqrt(1 - 0.98²)
      EXPECT_FALSE(growth(method, 1.0, 0.0, 1.02 * limit) < 100.0);  // nor if it is not finite
    } else {
      EXPECT_GT(growth(method, 1.0, 0.0, 0.2), 1.2);
    }
  });
}

}  // namespace
}  // namespace spring_pendulum
