#include "simulation/advice/linear_stability.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/outcome.hpp>
#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "support/random_scenes.hpp"
#include "support/verdict_of_run.hpp"

namespace spring_pendulum::test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr double kDuration = 5.0;  // s

Scenario scenarioOf(const Scene& scene, const Method& method, double step) {
  Scenario scenario;
  scenario.method = method;
  scenario.time_step = step;
  scenario.steps_per_frame = std::max<std::int64_t>(1, std::llround(0.1 / step));
  scenario.frames =
      std::llround(kDuration / (step * static_cast<double>(scenario.steps_per_frame))) + 1;
  scenario.constants = scene.chain.constants();
  return scenario;
}

bool isStable(const Scene& scene, const Method& method, double step) {
  const auto kind = VerdictKind::kGainedEnergy;
  return verdictOfRun(scene, method, step, kDuration, true, kind).kind < kind;
}

TEST(StabilityAdvice, LargestStableStepIsThatOfRealRuns) {
  for (const unsigned seed : {1U, 6U, 14U, 18U, 29U}) {
    const Scene scene = randomScene(seed);
    SCOPED_TRACE(scene.name);
    forEachFixedStepMethod([&](const Method& method) {
      const double step =
          largestStableStep(scene.chain, scene.start, scenarioOf(scene, method, 0.01)).step;
      ASSERT_GT(step, 0.0);
      if (std::isinf(step)) {
        EXPECT_TRUE(isStable(scene, method, kDuration));
        return;
      }
      EXPECT_TRUE(isStable(scene, method, 0.9 * step)) << step;
      EXPECT_TRUE(isStable(scene, method, 0.95 * step)) << step;
      EXPECT_FALSE(isStable(scene, method, 1.05 * step) && isStable(scene, method, 1.1 * step))
          << step;
    });
  }
}

// Twice the damping over the stiffness: 2 * 0.5 / 18.79, rounded down.
TEST(StabilityAdvice, OneStepIsNamedEverywhere) {
  const Chain chain(Eigen::Vector2d::Ones(), {18.79, 1.0, 1.0}, 9.81);
  State start(2);
  start.y()[1] = -1.3;
  Scenario scenario;
  scenario.method = findMethod("Euler");
  scenario.time_step = 0.5;
  scenario.steps_per_frame = 1;
  EXPECT_EQ(largestStableStep(chain, start, scenario).step, 0.0532);
  EXPECT_THAT(checkStability(chain, start, scenario).text, HasSubstr("step size: 0.0532 s\n"));
  EXPECT_THAT(stabilityWarning(chain, start, scenario),
              HasSubstr(" of 0.5 s; largest stable step for Euler: 0.0532 s; or use Auto"));
  EXPECT_THAT(remedyForDivergence(chain, start, scenario), HasSubstr("0.0532 s; or use Auto"));
}

TEST(StabilityAdvice, LargestStepsAreConfirmed) {
  Scenario scenario;
  scenario.steps_per_frame = 1;
  scenario.frames = 21;
  // A step of 0.138 s is stable and accurate, one of 0.124 s is not accurate.
  const Chain three(Eigen::Vector3d::Ones(), {200.0, 0.05, 1.0}, 9.81);
  EXPECT_LT(checkStability(three, straightLine(3, 1.1, 0.0), scenario).accurate_step, 0.124);
  // The energy error of one step in free fall, g² h²/2, is 1 % of the scale at h = 0.047315 s.
  scenario.method = findMethod("Euler");
  scenario.time_step = 0.04735;
  scenario.frames = 2;
  const Chain two(Eigen::Vector2d::Ones(), {50.0, 1.0, 1.0}, 9.81);
  EXPECT_LT(largestStableStep(two, straightLine(2, 1.0, 0.0), scenario).step, 0.0473);
}

TEST(StabilityAdvice, LargestAccurateStepKeepsOnePercentOfTheLength) {
  const Scene scene = horizontalChain("", 6, 1.0);
  forEachFixedStepMethod([&](const Method& method) {
    const double step =
        checkStability(scene.chain, scene.start, scenarioOf(scene, method, 1e-4)).accurate_step;
    ASSERT_GT(step, 0.0);
    const auto verdict_at = [&](double tried) {
      return checkStability(scene.chain, scene.start, scenarioOf(scene, method, tried))
          .verdict.value();
    };
    EXPECT_FALSE(isBad(verdict_at(0.95 * step).kind)) << step;
    EXPECT_TRUE(isBad(verdict_at(1.2 * step).kind)) << step;
  });
}

// Air takes code without a fast kernel. Counted work of both differed from real time by a factor of 18.
TEST(StabilityAdvice, ResemblesItselfWithAndWithoutSlightAir) {
  const Scene scene = horizontalChain("", 6, 1.0);
  Scenario scenario = scenarioOf(scene, findMethod("Runge-Kutta-4"), 1e-3);
  const StabilityReport without = checkStability(scene.chain, scene.start, scenario);
  scenario.constants.air_drag = 1e-9;
  const auto with = checkStability(inAir(scene.chain, 1e-9), scene.start, scenario);
  EXPECT_EQ(with.stable.step, without.stable.step);
  EXPECT_NEAR(with.accurate_step, without.accurate_step, 0.04 * without.accurate_step);
}

TEST(StabilityAdvice, CheckReportsTheVeryRun) {
  const Scene scene = horizontalChain("", 11, 1.0);
  Scenario scenario;
  scenario.frames = 51;
  const std::string text = checkStability(scene.chain, scene.start, scenario).text;
  // 5.93e-6 m is known independently for the largest coordinate.
  EXPECT_THAT(text, StartsWith("Runge-Kutta-4 with a step size of 0.01 s over 5 s: ok\nlargest "
                               "position error 6.4e-06 m at t = 4.7 s, largest energy error "));
  EXPECT_THAT(text, testing::ContainsRegex("stable step size: 0.2.*\nlargest accurate .*: 0.1"));
  scenario.frames = 1;
  EXPECT_THAT(checkStability(scene.chain, scene.start, scenario).text, HasSubstr(" over 0 s: ok"));
  scenario.frames = 401;  // chaotic from 33 s on
  const Chain undamped(scene.chain.masses(), {50.0, 0.0, 1.0}, 9.81);
  EXPECT_THAT(checkStability(undamped, scene.start, scenario).text,
              HasSubstr("s, when the motion is sensitive\n"));
}

TEST(StabilityAdvice, CheckSaysWhatIsTooLargeToTry) {
  const Scene scene = horizontalChain("", 30000, 1.0);
  EXPECT_THAT(
      checkStability(scene.chain, scene.start, {}).text,
      StartsWith("Runge-Kutta-4: takes too long to try\nlargest stable step size: 0.05 s (linear "
                 "estimate)\n"));
}

// The reference run reaches 14 s.
TEST(StabilityAdvice, CheckSaysThatAccuracyWouldTakeTooLongToJudge) {
  const Eigen::Vector4d masses{1.0, 1.0, 1e-4, 1.0};
  const Chain chain(masses, {50.0, 1.0, 1.0}, 9.81);
  Scenario scenario;
  scenario.frames = 201;
  EXPECT_THAT(checkStability(chain, straightLine(4, 1.0, 0.0), scenario).text,
              ContainsRegex("stable step size: 0.0001.* s\nlargest accurate step size: unknown, as "
                            "a reference run would take too long\n"));
}

TEST(StabilityAdvice, RemedyNamesAStepThatIsStable) {
  const Scene light = horizontalChain("", 11, 0.001);
  const std::string text = remedyForDivergence(light.chain, light.start, Scenario{});
  const std::string before = "largest stable step for Runge-Kutta-4: ";
  ASSERT_THAT(text, StartsWith(before));
  EXPECT_TRUE(isStable(light, findMethod("Runge-Kutta-4"), std::stod(text.substr(before.size()))));
  Scenario other;
  other.method = findMethod("Auto");
  EXPECT_EQ(remedyForDivergence(light.chain, light.start, other), "try a tolerance below 1e-06 m");
  other.method = findMethod("Backward-Euler");  // has no limit, but Newton's method may fail
  const std::string of_newton = remedyForDivergence(light.chain, light.start, other);
  EXPECT_THAT(of_newton, StartsWith("try a step below 0.01 s"));
}

TEST(StabilityAdvice, RemedyEndsWhenItIsStopped) {
  const Scene light = horizontalChain("", 11, 0.001);
  int asked = 0;
  const auto stop = [&asked] { return ++asked > 3; };
  EXPECT_EQ(remedyForDivergence(light.chain, light.start, Scenario{}, stop), "");
  EXPECT_GT(asked, 3);
}

TEST(StabilityAdvice, RefusesWhatHasNoAnswer) {
  const Scene scene = horizontalChain("", 3, 1.0);
  const Scenario other = scenarioOf(scene, findMethod("Auto"), 0.01);
  EXPECT_TRUE(std::isnan(largestStableStep(scene.chain, scene.start, other).step));
  Scenario negative;
  negative.frames = -5;
  EXPECT_THROW(checkStability(scene.chain, scene.start, negative), InputError);
  EXPECT_THROW(remedyForDivergence(scene.chain, scene.start, negative), InputError);
}

/// A method of a program that never reaches the next frame.
class Slow final : public Integrator {
 public:
  void integrate(State&, double, std::int64_t) override { FAIL() << "not asked to stop"; }
  std::int64_t integrateWithin(State&, double, std::int64_t, double) override {
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
  const Scene scene = horizontalChain("", 3, 1.0);
  Scenario scenario;
  scenario.method = method;
  EXPECT_EQ(checkStability(scene.chain, scene.start, scenario).text,
            "Slow: takes too long to try\n");
}

TEST(StabilityWarning, NeverComesBeforeAStableRun) {
  const auto bad = VerdictKind::kGainedEnergy;
  int unstable = 0, warned = 0;
  for (unsigned seed = 0; seed < 36; ++seed) {
    const Scene scene = randomScene(seed);
    SCOPED_TRACE(scene.name);
    forEachFixedStepMethod([&](const Method& method) {
      for (const double step : {1e-3, 3e-3, 1e-2, 3e-2, 1e-1, 0.3}) {
        const bool warns = isClearlyUnstable(method, scene.chain, step, kDuration);
        const bool is_unstable =
            verdictOfRun(scene, method, step, kDuration, false, bad).kind >= bad;
        EXPECT_TRUE(!warns || is_unstable) << step << " s";
        unstable += is_unstable ? 1 : 0;
        warned += warns ? 1 : 0;
      }
    });
  }
  EXPECT_GE(warned, unstable / 2) << "of " << unstable;
}

TEST(StabilityWarning, IsSilentWithoutSpringsOrSteps) {
  const Scene light = horizontalChain("", 11, 0.001);
  Scenario still = scenarioOf(light, findMethod("Euler"), 0.01);
  still.frames = 1;
  EXPECT_THAT(stabilityWarning(light.chain, light.start, still), IsEmpty());
  const Chain alone(Eigen::VectorXd::Ones(1), SpringLaw{}, 9.81);
  EXPECT_THAT(stabilityWarning(alone, State(1), Scenario{}), IsEmpty());
}

// Neither the energy of a test spring nor the duration may exceed the range of a double.
TEST(StabilityWarning, ComesAlsoWithExtremeValues) {
  const Chain chain(Eigen::Vector2d::Ones(), {50.0, 1e160, 1.0}, 9.81);
  EXPECT_THAT(stabilityWarning(chain, straightLine(2, 1.0, 0.0), Scenario{}),
              StartsWith("Runge-Kutta-4 may be unstable with a time step of 0.01 s; largest"));
  Scenario long_step;
  long_step.time_step = 1e308;
  long_step.frames = 2;
  long_step.steps_per_frame = 1;
  const Scene scene = horizontalChain("", 11, 1.0);
  EXPECT_THAT(stabilityWarning(scene.chain, scene.start, long_step),
              StartsWith("Runge-Kutta-4 may be unstable with a time step of 1e+308 s; largest"));
}

}  // namespace
}  // namespace spring_pendulum::test
