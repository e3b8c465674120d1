// What every error-controlled method costs, counted. A change that makes a method dearer or cheaper is
// seen here on every machine, without a clock. If the change is meant, put the printed row in the table.
#include "integration/error_control/dense_output_integrator.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "support/reference.hpp"
#include "support/scenes.hpp"

namespace spring_pendulum {
namespace {

/// Force evaluations / accepted steps until 0.5 s of Dormand-Prince-5, Taylor-8, Taylor-12,
/// Stabilized-Taylor-4, Stabilized-Taylor-8, Radau-9, Auto.
const std::map<std::string, std::string> kWorks = {
    {"stiff_cable",
     " 74527/12420 52232/6529 34140/2845 60048/15012 22840/2855 18767/1706 35425/2845"},
    {"single_vertical", " 337/56 80/10 36/3 1040/260 120/15 150/14 36/3"},
    {"two_masses_45deg", " 367/61 104/13 72/6 1024/256 136/17 196/15 72/6"},
    {"horizontal_11", " 331/55 120/15 84/7 1048/262 152/19 222/16 84/7"},
    {"light_100", " 2575/429 336/42 372/31 1508/377 290/32 406/23 372/31"},
    {"lighter_100", " 10849/1808 3672/459 4080/340 2246/458 1172/85 524/26 1921/115"},
};

test::Scene stiffCable() {
  const SpringLaw spring{5e5, 0.0, 0.01};
  return {"stiff_cable", Chain(Eigen::VectorXd::Constant(100, 0.01), spring, 9.81),
          test::straightLine(100, 0.0, -0.01)};
}

std::string worksOf(const test::Scene& scene) {
  std::string works;
  for (const Method& method : methodTable()) {
    if (method.hasFixedStep()) continue;
    const auto integrator = makeIntegrator(method, scene.chain, {1e-6});
    State state = scene.start;
    integrator->advance(state, 0.05, 10);
    const auto& stepper = dynamic_cast<const DenseOutputIntegrator&>(*integrator);
    works += fmt::format(" {}/{}", integrator->forceEvaluations(), stepper.statistics().accepted);
  }
  return works;
}

TEST(CountedWork, IsThatOfTheTable) {
  std::vector<test::Scene> scenes{stiffCable()};
  for (const char* name :
       {"single_vertical", "two_masses_45deg", "horizontal_11", "light_100", "lighter_100"})
    scenes.push_back(test::referenceScene(name));
  for (const test::Scene& scene : scenes)
    EXPECT_EQ(worksOf(scene), kWorks.at(scene.name)) << scene.name;
}

}  // namespace
}  // namespace spring_pendulum
