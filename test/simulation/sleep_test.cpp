// The option `sleep`: a chain at rest is not integrated.
#include <gtest/gtest.h>

#include "support/program_run.hpp"

namespace spring_pendulum {
namespace {

/// Whether a run stays asleep from this start on.
bool sleeps(const State& start, double tolerance) {
  const test::Scene scene{"three", Chain(Eigen::VectorXd::Ones(3), {}), start};
  Scenario scenario;
  scenario.sleep = tolerance;
  scenario.frames = 2;
  test::ProgramRun run(scenario, scene);
  run.advance();
  return run.integrator().forceEvaluations() == 0;
}

TEST(Sleep, ChainAtRestIsFoundAndAnythingElseIsNot) {
  const State rest = test::hangingAtRest(Chain(Eigen::VectorXd::Ones(3), {}));
  EXPECT_TRUE(sleeps(rest, 1e-9));
  State moving = rest;
  moving.vx()[2] = 2e-9;
  EXPECT_FALSE(sleeps(moving, 1e-9));
  State turning = rest;  // without speed, but 1e-7 m too low: 50 N/m give 5e-7 m/s in 0.1 s
  turning.y()[2] -= 1e-7;
  EXPECT_FALSE(sleeps(turning, 1e-9));
  EXPECT_TRUE(sleeps(turning, 1e-6));
}

}  // namespace
}  // namespace spring_pendulum
