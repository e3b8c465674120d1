// What a run says about its memory before it starts. process_exercise3_memory_test measures it.
#include "simulation/expected_memory.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <gtest/gtest.h>

namespace spring_pendulum {
namespace {

Scenario scenarioOf(const char* method) {
  Scenario scenario;
  scenario.method = findMethod(method);
  return scenario;
}

TEST(Memory, IsSaidWhereItIsMuch) {
  EXPECT_EQ(memoryRemark(scenarioOf("Radau-9"), 100000), "");
  EXPECT_EQ(memoryRemark(scenarioOf("Runge-Kutta-4"), 1000000), "");
  EXPECT_EQ(memoryRemark(scenarioOf("Runge-Kutta-4"), 4000000),
            "Runge-Kutta-4 takes up to 0.64 GB of memory for 4000000 particles");
}

TEST(Memory, OfReferenceRunsCountsIfTheyAreAskedFor) {
  Scenario scenario = scenarioOf("Euler");
  const double without = expectedMemory(scenario, 1000);
  scenario.reference = ReferenceUse::kAlways;
  EXPECT_GT(expectedMemory(scenario, 1000), 10.0 * without);
}

}  // namespace
}  // namespace spring_pendulum
