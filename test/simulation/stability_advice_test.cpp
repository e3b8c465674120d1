#include "simulation/advice/trial.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/reference_run.hpp>
#include <spring_pendulum/simulation/stability_advice.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <regex>
#include <string>

#include "support/random_scenes.hpp"
#include "support/verdict_of_run.hpp"

namespace spring_pendulum {
namespace {

using test::forEachFixedStepMethod;
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
    const auto error_at = [&](double step) {
      return bench.run(method, step, ReferenceUse::kAuto).position_error.largest;
    };
    EXPECT_LE(error_at(limits.accurate), allowed);
    EXPECT_GT(error_at(1.5 * limits.accurate), allowed);
  });
}

TEST(StabilityAdvice, CheckReportsTheVeryRun) {
  const Scene scene = test::horizontalChain("", 11, 1.0);
  Scenario scenario;
  scenario.frames = 51;
  const std::string text = checkStability(scene.chain, scene.start, scenario).text;
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
      checkStability(scene.chain, scene.start, scenario).text,
      ContainsRegex("position error of at most 1e-06 m: Taylor-[0-9]+ with a tolerance of 1e-0"));
}

TEST(StabilityAdvice, TheMethodFoundKeepsTheWantedError) {
  for (const unsigned seed : {1U, 14U, 37U, 59U}) {
    const Scene scene = test::randomScene(seed);
    Scenario scenario;
    scenario.method = findMethod("Auto");
    scenario.frames = 51;
    scenario.wanted_error = 1e-2;
    const std::string text = checkStability(scene.chain, scene.start, scenario).text;
    std::smatch found;
    const std::regex advice(" m: ([A-Za-z0-9-]+) with a [a-z ]+ of ([0-9.e-]+) ");
    ASSERT_TRUE(std::regex_search(text, found, advice)) << text;
    const TrialBench bench(scene.chain, scene.start, kDuration, kFrameInterval);
    for (const double share : {1.0, 0.95, 0.9}) {
      const Trial trial =
          bench.run(findMethod(found.str(1)), share * std::stod(found[2]), ReferenceUse::kAuto);
      EXPECT_TRUE(trial.measured) << scene.name;
      EXPECT_LE(trial.position_error.largest, scenario.wanted_error) << scene.name << ": " << text;
    }
  }
}

TEST(StabilityAdvice, CheckSaysWhatIsTooLargeToTry) {
  const Scene scene = test::horizontalChain("", 10000, 1.0);
  EXPECT_THAT(
      checkStability(scene.chain, scene.start, Scenario{}).text,
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
  EXPECT_THAT(checkStability(chain, test::straightLine(4, 1.0, 0.0), scenario).text,
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

TEST(StabilityAdvice, RemedyEndsWhenItIsStopped) {
  const Scene light = test::horizontalChain("", 11, 0.001);
  int asked = 0;
  const auto stop = [&asked] { return ++asked > 3; };
  EXPECT_EQ(remedyForDivergence(light.chain, light.start, Scenario{}, stop), "");
  EXPECT_GT(asked, 3);
}

TEST(StabilityAdvice, RefusesWhatHasNoAnswer) {
  const Scene scene = test::horizontalChain("", 3, 1.0);
  EXPECT_THROW(findStepLimits(findMethod("Auto"), scene.chain, scene.start, 0.01, 1.0, 0.1),
               InputError);
  Scenario negative;
  negative.frames = -5;
  EXPECT_THROW(checkStability(scene.chain, scene.start, negative), InputError);
  EXPECT_THROW(remedyForDivergence(scene.chain, scene.start, negative), InputError);
}

/// A method of a program that never reaches the next frame.
class Slow final : public Integrator {
 public:
  void advance(State&, double, std::int64_t) override { FAIL() << "not asked to stop"; }
  std::int64_t advanceWithin(State&, double, std::int64_t, double) override {
    ++evaluations_;
    return 0;
  }
  std::int64_t forceEvaluations() const override { return evaluations_; }
  double dissipatedEnergy() const override { return 0.0; }
  double work() const override { return 1e-3 * static_cast<double>(evaluations_); }

 private:
  std::int64_t evaluations_ = 0;
};

TEST(StabilityAdvice, LimitsTheWorkOfOwnErrorControlledMethods) {
  Method method{"Slow", 1, 1, StepControl::kErrorControlled};
  method.make = [](const Method&, const Chain&, const IntegratorOptions&) {
    return std::make_unique<Slow>();
  };
  const Scene scene = test::horizontalChain("", 3, 1.0);
  Scenario scenario;
  scenario.method = method;
  EXPECT_EQ(checkStability(scene.chain, scene.start, scenario).text,
            "Slow: takes too long to try\n");
}

TEST(TrialBench, StartsNoTrialAfterAHundredFullOnes) {
  const Scene scene = test::randomScene(1);
  constexpr double kWork = 1e-4;  // s
  const TrialBench bench(scene.chain, scene.start, 1000.0, kFrameInterval, {}, kWork);
  const Method& method = findMethod("Runge-Kutta-4");
  int trials = 0;
  for (; !bench.isExhausted() && trials < 1000; ++trials) {
    EXPECT_FALSE(bench.run(method, 1e-3, ReferenceUse::kNever).finished);
  }
  EXPECT_GT(trials, 50);  // 74
  EXPECT_LE(trials, 100);
  EXPECT_EQ(bench.run(method, 1e-3, ReferenceUse::kNever).evaluations, 0);
}

}  // namespace
}  // namespace spring_pendulum
