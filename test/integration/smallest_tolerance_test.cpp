#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/reference.hpp"

namespace spring_pendulum {
namespace {

TEST(SmallestTolerance, GrowsWithTheCoordinates) {
  const Chain chain(Eigen::VectorXd::Ones(2), SpringLaw{}, 9.81);
  State state(2);
  state.x() << 0.0, 1.0;
  EXPECT_NEAR(smallestTolerance(chain, state), 2.2e-13, 0.2e-13);
  state.x() << 1e12, 1e12 + 1.0;
  EXPECT_NEAR(smallestTolerance(chain, state), 0.022, 0.002);
}

// A tolerance at this limit is met.
TEST(SmallestTolerance, IsReached) {
  test::Scene scene = test::referenceScene("two_masses_45deg");
  const double tolerance = smallestTolerance(scene.chain, scene.start);
  for (const char* method : {"Taylor-12", "Radau-9", "Auto"}) {
    State state = scene.start;
    makeIntegrator(method, scene.chain, {tolerance})->advance(state, 1.0, 1);
    EXPECT_LT(test::positionError(state, test::referenceSolution("two_masses_45deg", 1)),
              10.0 * tolerance)
        << method;
  }
}

// Impossible tolerances cost time, but runs end.
TEST(SmallestTolerance, BelowItEveryMethodEnds) {
  const Chain chain(Eigen::VectorXd::Ones(2), SpringLaw{}, 9.81);
  for (const Method& method : methodTable()) {
    for (const double tolerance : {1e-18, 1e-300}) {
      State state(2);
      state.x()[1] = 1.0;
      const auto integrator = makeIntegrator(method, chain, {tolerance});
      integrator->advance(state, 1e-7, 10);
      EXPECT_LT(integrator->forceEvaluations(), 1000000) << method.name << " at " << tolerance;
    }
  }
}

/// Two particles, a metre apart.
std::string messageFor(double tolerance, double place) {
  State state(2);
  state.x() << place, place + 1.0;
  try {
    checkTolerance(tolerance, Chain(Eigen::VectorXd::Ones(2), SpringLaw{}, 9.81), state);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SmallestTolerance, IsNamedByTheCheck) {
  EXPECT_EQ(messageFor(1e-12, 0.0), "");
  EXPECT_THAT(messageFor(1e-300, 0.0),
              testing::StartsWith("tolerance: must be at least 2.3e-13 m"));
  EXPECT_EQ(messageFor(2.3e-13, 0.0), "");
  EXPECT_THAT(messageFor(1e-6, 1e12), testing::StartsWith("tolerance: must be at least 2.3e-02 m"));
  EXPECT_EQ(messageFor(2.3e-2, 1e12), "");
}

}  // namespace
}  // namespace spring_pendulum
