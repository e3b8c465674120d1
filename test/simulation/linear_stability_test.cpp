#include "simulation/advice/linear_stability.hpp"

#include <spring_pendulum/simulation/outcome.hpp>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "support/random_scenes.hpp"
#include "support/verdict_of_run.hpp"

namespace spring_pendulum::test {
namespace {

constexpr double kDuration = 5.0;  // s

/// ln of the spectral radius of one step of 1 s on (q, q'/rate), for q'' + decay q' + swing² q = 0.
double growthOfIntegrator(const Method& method, double swing, double decay) {
  constexpr double kSize = 0x1p-10;
  const Chain chain(Eigen::Vector2d::Ones(), {swing * swing, decay, 1.0}, 0.0);
  const double rate = std::max(swing, decay);
  Eigen::Matrix2d matrix;
  for (int column = 0; column < 2; ++column) {
    State state(2);
    state.x()[1] = column == 0 ? 1.0 + kSize : 1.0;
    state.vx()[1] = column == 1 ? kSize * rate : 0.0;
    makeIntegrator(method, chain)->advance(state, 1.0, 1);
    matrix.col(column) << (state.x()[1] - 1.0) / kSize, state.vx()[1] / (kSize * rate);
  }
  return std::log(matrix.eigenvalues().cwiseAbs().maxCoeff());
}

TEST(GrowthPerStep, IsThatOfTheIntegrator) {
  for (const double swing : {0.01, 0.3, 1.1, 1.9, 2.1, 2.8, 2.9, 5.0})
    for (const double decay : {0.0, 0.01, 0.5, 1.0, 1.9, 2.5, 3.0}) {
      forEachFixedStepMethod([&](const Method& method) {
        EXPECT_NEAR(growthPerStep(method, swing, decay), growthOfIntegrator(method, swing, decay),
                    1e-7)
            << swing << " " << decay;
      });
    }
}

// The limits of the method table say the same as its tableaus, to the digits they are given with.
TEST(GrowthPerStep, ChangesSignAtTheLimitsOfTheTable) {
  forEachFixedStepMethod([](const Method& method) {
    const double real = method.real_stability_limit;
    if (std::isinf(real)) return;
    EXPECT_LE(growthPerStep(method, 0.0, 0.999999 * real), 0.0);
    EXPECT_GT(growthPerStep(method, 0.0, 1.000001 * real), 0.0);
    const double imaginary = method.imaginary_stability_limit;
    EXPECT_LE(imaginary > 0.0 ? growthPerStep(method, 0.999999 * imaginary, 0.0) : 0.0, 0.0);
    EXPECT_GT(growthPerStep(method, std::max(1.000001 * imaginary, 1e-3), 0.0), 0.0);
  });
}

TEST(GrowthPerStep, OfStabilizedMethodsReachesTheLimitOfTheTable) {
  const Method& method = findMethod("Stabilized-Taylor-4");
  EXPECT_LE(growthPerStep(method, 0.0, 0.99999 * method.real_stability_limit), 1e-5);
  EXPECT_GT(growthPerStep(method, 0.0, 1.01 * method.real_stability_limit), 0.0);
}

TEST(GrowthPerStep, OfOwnMethodsFollowsFromWhatTheirRowSays) {
  Method own{"Own", 3, 3, StepControl::kFixed};
  EXPECT_LE(growthPerStep(own, 0.0, 2.5), 0.0);  // limits of a third-order method: 2.513, 1.732
  EXPECT_GT(growthPerStep(own, 0.0, 2.52), 0.0);
  EXPECT_LE(growthPerStep(own, 1.73, 0.0), 0.0);
  EXPECT_GT(growthPerStep(own, 1.74, 0.0), 0.0);
  own.real_stability_limit = own.imaginary_stability_limit =
      std::numeric_limits<double>::infinity();
  EXPECT_LE(growthPerStep(own, 1e9, 0.0), 0.0);
  EXPECT_LE(growthPerStep(own, 1e9, 1e9), 0.0);
}

// Undamped oscillations grow at every step size: the energy of the slowest swing may grow by 1 %.
TEST(LinearStepLimit, OfEulerDependsOnTheDuration) {
  const Scene scene = horizontalChain("", 11, 1.0);
  const Method& euler = findMethod("Euler");
  const double step = linearStepLimit(euler, scene.chain, 10.0);
  EXPECT_NEAR(step / linearStepLimit(euler, scene.chain, 100.0), 10.0, 0.2);
  const Method& classical = findMethod("Runge-Kutta-4");
  EXPECT_NEAR(linearStepLimit(classical, scene.chain, 10.0) /
                  linearStepLimit(classical, scene.chain, 100.0),
              1.0, 1e-3);
}

TEST(LinearStepLimit, IsStable) {
  int cases = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    const Scene scene = randomScene(seed);
    SCOPED_TRACE(scene.name);
    forEachFixedStepMethod([&](const Method& method) {
      const double step = linearStepLimit(method, scene.chain, kDuration);
      if (kDuration / step > 1e5) return;
      ++cases;
      // The energy of the symplectic Euler method sways with its first-order error, however stable.
      const auto kind = method.name == "Semi-Implicit-Euler" ? VerdictKind::kDiverged
                                                             : VerdictKind::kGainedEnergy;
      EXPECT_LT(verdictOfRun(scene, method, step, kDuration, true, kind).kind, kind) << step;
    });
  }
  EXPECT_GE(cases, 90);
}

TEST(LinearStepLimit, IsInfiniteWithoutSprings) {
  const Chain fixed(Eigen::VectorXd::Ones(1), SpringLaw{}, 9.81);
  for (const Method& method : methodTable())
    EXPECT_TRUE(std::isinf(linearStepLimit(method, fixed, kDuration))) << method.name;
}

}  // namespace
}  // namespace spring_pendulum::test
