#include "simulation/integrator_settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace spring_pendulum {
namespace {

using testing::HasSubstr;
using testing::UnorderedElementsAre;

std::vector<std::string> skippedIn(const Scenario& scenario, const Eigen::VectorXd& masses) {
  const Chain chain(masses, scenario.spring(), scenario.gravity);
  return skippedWork(scenario, *makeIntegrator(scenario.method, chain), !scenario.energy.empty());
}

TEST(SkippedWork, NamesWhatTheSceneDoesNotNeed) {
  Scenario scenario;
  scenario.damping = 0.0;
  scenario.gravity = 0.0;
  scenario.no_frames = true;
  EXPECT_THAT(skippedIn(scenario, Eigen::VectorXd::Ones(4)),
              UnorderedElementsAre(HasSubstr("velocity differences"), HasSubstr("gravity"),
                                   HasSubstr("masses"), HasSubstr("dissipated energy"),
                                   HasSubstr("frame files")));
}

TEST(SkippedWork, IsNothingWhereAllIsNeeded) {
  Scenario scenario;
  scenario.energy = "energy.csv";
  EXPECT_THAT(skippedIn(scenario, Eigen::VectorXd::LinSpaced(4, 1.0, 2.0)), testing::IsEmpty());
}

TEST(IntegratorOptions, AreThoseOfTheScenario) {
  Scenario scenario;
  scenario.tolerance = 1e-3;
  scenario.threads = 3;
  const IntegratorOptions options = integratorOptions(scenario, true);
  EXPECT_EQ(options.tolerance, 1e-3);
  EXPECT_EQ(options.threads, 3);
  EXPECT_TRUE(options.track_dissipation);
}

}  // namespace
}  // namespace spring_pendulum
