#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/run.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "support/scenes.hpp"

namespace spring_pendulum {
namespace {

Particles particlesOf(const test::Scene& scene) {
  return {AlignedNumbers(scene.chain.masses()), scene.start};
}

Scenario scenarioOf(const test::Scene& scene, const char* method) {
  Scenario scenario;
  scenario.method = findMethod(method);
  scenario.frames = 60;
  scenario.stiffness = scene.chain.spring().stiffness;
  scenario.damping = scene.chain.spring().damping;
  scenario.rest_length = scene.chain.spring().rest_length;
  scenario.gravity = scene.chain.gravity();
  return scenario;
}

Run finished(const Scenario& scenario, const Particles& particles, const RunOptions& options = {}) {
  Run run(scenario, particles, options);
  const auto integrator = run.makeIntegrator();
  while (run.advance(*integrator)) {
  }
  return run;
}

// The tolerances of both are the same, and so is each output time.
TEST(SharedReference, GivesTheBitsOfAReferenceOfItsOwn) {
  const test::Scene scene = test::horizontalChain("", 11, 1.0);
  const auto shared = std::make_shared<SharedReference>(scene.chain, scene.start, 0.1);
  for (const char* method : {"Auto", "Dormand-Prince-5", "Taylor-12"}) {
    const Scenario scenario = scenarioOf(scene, method);
    const auto alone = finished(scenario, particlesOf(scene));
    const auto sharing = finished(scenario, particlesOf(scene), {false, 0.0, {}, shared});
    EXPECT_GT(alone.positionError().largest, 0.0) << method;
    EXPECT_EQ(sharing.positionError().largest, alone.positionError().largest) << method;
    EXPECT_EQ(sharing.positionError().bound, alone.positionError().bound) << method;
    EXPECT_EQ(sharing.verdict().text, alone.verdict().text) << method;
  }
}

// Measured: the errors differ by at most 2e-13 m.
TEST(SharedReference, ServesAllStepSizesInSeveralThreads) {
  const test::Scene scene = test::horizontalChain("", 11, 1.0);
  const auto shared = std::make_shared<SharedReference>(scene.chain, scene.start, 0.1);
  std::vector<std::thread> threads;
  for (const int steps : {1, 5, 10, 40}) {
    threads.emplace_back([&scene, &shared, steps] {
      Scenario scenario = scenarioOf(scene, "Runge-Kutta-4");
      scenario.steps_per_frame = steps;
      scenario.time_step = 0.1 / steps;
      const auto alone = finished(scenario, particlesOf(scene));
      const auto sharing = finished(scenario, particlesOf(scene), {false, 0.0, {}, shared});
      EXPECT_NEAR(sharing.positionError().largest, alone.positionError().largest, 1e-11) << steps;
      EXPECT_EQ(sharing.verdict().kind, alone.verdict().kind) << steps;
      EXPECT_EQ(sharing.verdict().time, alone.verdict().time) << steps;
    });
  }
  for (std::thread& thread : threads) thread.join();
}

// The reference of this chain uses up the work that a run allows it; which frame that is depends on
// the run. An expensive run must not take the measurement away from a cheap one, or the reverse.
TEST(SharedReference, StopsForEachRunWhereItsOwnWould) {
  const test::Scene scene = test::horizontalChain("", 400, 1e-3);
  const auto shared = std::make_shared<SharedReference>(scene.chain, scene.start, 0.02);
  std::vector<double> stops;
  for (const int steps : {20, 800, 20}) {
    Scenario scenario = scenarioOf(scene, "Runge-Kutta-4");
    scenario.steps_per_frame = steps;
    scenario.time_step = 0.02 / steps;
    const auto alone = finished(scenario, particlesOf(scene));
    const auto sharing = finished(scenario, particlesOf(scene), {false, 0.0, {}, shared});
    EXPECT_EQ(alone.positionError().measured_until, sharing.positionError().measured_until);
    EXPECT_EQ(alone.verdict().text, sharing.verdict().text);
    stops.push_back(sharing.positionError().measured_until);
  }
  EXPECT_LT(stops[0], stops[1]);
  EXPECT_EQ(stops[0], stops[2]);
}

TEST(SharedReference, RefusesAnotherChainAndBadTimes) {
  const test::Scene scene = test::horizontalChain("", 11, 1.0);
  const auto shared = std::make_shared<SharedReference>(scene.chain, scene.start, 0.1);
  const test::Scene other = test::horizontalChain("", 12, 1.0);
  EXPECT_THROW(finished(scenarioOf(other, "Euler"), particlesOf(other), {false, 0.0, {}, shared}),
               InputError);
  EXPECT_THROW(SharedReference(scene.chain, other.start, 0.1), InputError);
  EXPECT_THROW(SharedReference(scene.chain, scene.start, 0.0), InputError);
  EXPECT_THROW(shared->frame(-1, 1.0), InputError);
}

}  // namespace
}  // namespace spring_pendulum
