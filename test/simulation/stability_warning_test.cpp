#include "simulation/advice/linear_stability.hpp"
#include <spring_pendulum/simulation/scenario.hpp>
#include <spring_pendulum/simulation/stability_advice.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/random_scenes.hpp"
#include "support/verdict_of_run.hpp"

namespace spring_pendulum {
namespace {

using test::Scene;
using testing::IsEmpty;
using testing::StartsWith;

Scenario scenarioOf(const Scene& scene, const std::string& method, double step, double duration) {
  Scenario scenario;
  scenario.method = findMethod(method);
  scenario.time_step = step;
  scenario.constants = scene.chain.constants();
  scenario.steps_per_frame = 1;
  scenario.frames = std::llround(duration / step) + 1;
  return scenario;
}

TEST(StabilityWarning, NeverComesBeforeAStableRun) {
  constexpr double kDuration = 5.0;  // s
  const auto bad = VerdictKind::kGainedEnergy;
  int unstable = 0;
  int warned = 0;
  for (unsigned seed = 0; seed < 36; ++seed) {
    const Scene scene = test::randomScene(seed);
    SCOPED_TRACE(scene.name);
    for (const Method& method : methodTable()) {
      if (!method.hasFixedStep()) continue;
      for (const double step : {1e-3, 3e-3, 1e-2, 3e-2, 1e-1, 0.3}) {
        const bool warns = isClearlyUnstable(method, scene.chain, step, kDuration);
        const bool is_unstable =
            test::verdictOfRun(scene, method, step, kDuration, false, bad).kind >= bad;
        EXPECT_TRUE(!warns || is_unstable) << method.name << ", " << step << " s";
        unstable += is_unstable ? 1 : 0;
        warned += warns ? 1 : 0;
      }
    }
  }
  EXPECT_GE(warned, unstable / 2) << "of " << unstable;
}

TEST(StabilityWarning, IsSilentWithoutSpringsOrSteps) {
  const Scene light = test::horizontalChain("", 11, 0.001);
  Scenario still = scenarioOf(light, "Euler", 0.01, 5.0);
  still.frames = 1;
  EXPECT_THAT(stabilityWarning(light.chain, light.start, still), IsEmpty());
  const Chain alone(Eigen::VectorXd::Ones(1), SpringLaw{}, 9.81);
  const State anchor(1);
  EXPECT_THAT(stabilityWarning(alone, anchor, Scenario{}), IsEmpty());
}

// Neither the energy of a test spring nor the duration may exceed the range of a double.
TEST(StabilityWarning, ComesAlsoWithExtremeValues) {
  const Chain chain(Eigen::Vector2d::Ones(), {50.0, 1e160, 1.0}, 9.81);
  EXPECT_THAT(stabilityWarning(chain, test::straightLine(2, 1.0, 0.0), Scenario{}),
              StartsWith("Runge-Kutta-4 may be unstable with a time step of 0.01 s; largest"));
  Scenario long_step;
  long_step.time_step = 1e308;
  long_step.frames = 2;
  long_step.steps_per_frame = 1;
  const Scene scene = test::horizontalChain("", 11, 1.0);
  EXPECT_THAT(stabilityWarning(scene.chain, scene.start, long_step),
              StartsWith("Runge-Kutta-4 may be unstable with a time step of 1e+308 s; largest"));
}

}  // namespace
}  // namespace spring_pendulum
