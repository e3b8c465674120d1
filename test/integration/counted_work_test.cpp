// What every error-controlled method costs, counted. A change that makes a method dearer or cheaper is
// seen here on every machine, without a clock. If the change is meant, put the printed row in the table.
#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "support/reference.hpp"
#include "support/scenes.hpp"

namespace spring_pendulum {
namespace {

using Counts = std::vector<std::int64_t>;

// Force evaluations until 0.5 s: Dormand-Prince-5, Taylor-8, Taylor-12, Stabilized-Taylor-4,
// Stabilized-Taylor-8, Radau-9, Auto.
const std::map<std::string, Counts> kEvaluations = {
    {"stiff_cable", {74527, 52232, 34140, 60048, 22840, 18767, 35292}},
    {"single_vertical", {337, 80, 36, 1040, 120, 150, 36}},
    {"two_masses_45deg", {367, 104, 72, 1024, 136, 191, 72}},
    {"horizontal_11", {331, 120, 84, 1048, 152, 227, 84}},
    {"light_100", {2575, 336, 372, 1508, 290, 416, 372}},
    {"lighter_100", {10849, 3672, 4080, 2246, 1172, 529, 1921}},
};

test::Scene stiffCable() {
  const SpringLaw spring{5e5, 0.0, 0.01};
  return {"stiff_cable", Chain(Eigen::VectorXd::Constant(100, 0.01), spring, 9.81),
          test::straightLine(100, 0.0, -0.01)};
}

Counts evaluationsOf(const test::Scene& scene) {
  Counts counts;
  for (const Method& method : methodTable()) {
    if (method.hasFixedStep()) continue;
    const auto integrator = makeIntegrator(method, scene.chain, {1e-6});
    State state = scene.start;
    integrator->advance(state, 0.05, 10);
    counts.push_back(integrator->forceEvaluations());
  }
  return counts;
}

TEST(CountedWork, IsThatOfTheTable) {
  std::vector<test::Scene> scenes{stiffCable()};
  for (const char* name :
       {"single_vertical", "two_masses_45deg", "horizontal_11", "light_100", "lighter_100"}) {
    scenes.push_back(test::referenceScene(name));
  }
  for (const test::Scene& scene : scenes) {
    EXPECT_EQ(evaluationsOf(scene), kEvaluations.at(scene.name)) << scene.name;
  }
}

}  // namespace
}  // namespace spring_pendulum
