#include "simulation/integrator_settings.hpp"

#include <gtest/gtest.h>

namespace spring_pendulum {
namespace {

std::string skippedIn(const Scenario& scenario, const Eigen::VectorXd& masses) {
  const Chain chain(masses, scenario.spring(), scenario.gravity);
  return skippedWork(scenario, *makeIntegrator(scenario.method, chain), !scenario.energy.empty());
}

TEST(SkippedWork, NamesWhatTheSceneDoesNotNeed) {
  Scenario scenario;
  scenario.damping = 0.0;
  scenario.gravity = 0.0;
  scenario.no_frames = true;
  EXPECT_EQ(skippedIn(scenario, Eigen::VectorXd::Ones(4)),
            "skipped: velocity differences: damping is 0\n"
            "skipped: gravity: it is 0\n"
            "skipped: reading masses: all moving particles have the same mass\n"
            "skipped: dissipated energy: damping is 0\n"
            "skipped: frame files: not written\n");
}

TEST(SkippedWork, IsNothingWhereAllIsNeeded) {
  Scenario scenario;
  scenario.energy = "energy.csv";
  EXPECT_EQ(skippedIn(scenario, Eigen::VectorXd::LinSpaced(4, 1.0, 2.0)), "");
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
