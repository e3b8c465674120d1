#include "integration/automatic/auto_stepper.hpp"

#include "integration/error_control/dense_output_integrator.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "support/reference.hpp"
#include "support/scenes.hpp"

namespace spring_pendulum {
namespace {

// The method that Auto works with after `seconds`.
std::string methodAfter(const test::Scene& scene, double tolerance, double seconds) {
  AutoStepper stepper(scene.chain, tolerance);
  stepper.start(scene.start);
  for (double time = 0.0; time < seconds;) {
    const double h = stepper.step();
    if (!(h > 0.0)) return "diverged";
    time += h;
  }
  return std::string(stepper.method());
}

TEST(Auto, PicksBySceneAndTolerance) {
  EXPECT_EQ(methodAfter(test::referenceScene("horizontal_11"), 1e-3, 5.0), "Taylor-12");
  EXPECT_EQ(methodAfter(test::referenceScene("lighter_100"), 1e-3, 1.0), "Stabilized-Taylor-4");
  const test::Scene light{"", Chain(Eigen::Vector2d(1.0, 1e-6), SpringLaw{}, 9.81),
                          test::straightLine(2, 1.0, 0.0)};
  EXPECT_EQ(methodAfter(light, 1e-3, 1.0), "Radau-9");
  // Nothing damps the vibrations of a steel wire, but they stay far below the tolerance.
  const Chain wire(Eigen::VectorXd::Constant(21, 8e-4), SpringLaw{2e6, 0.0, 0.05}, 9.81);
  EXPECT_EQ(methodAfter({"", wire, test::straightLine(21, 0.03, -0.04)}, 1e-4, 2.0), "Radau-9");
  EXPECT_EQ(methodAfter(test::referenceScene("horizontal_11"), 1.0, 5.0), "Taylor-8");
  EXPECT_EQ(methodAfter(test::referenceScene("lighter_100"), 1e-10, 1.0), "Stabilized-Taylor-8");
}

// Springs make the light chain stiff; the error allowed makes long steps of low order cheaper.
TEST(Auto, ChangesTheMethodWithTheMotion) {
  const test::Scene scene = test::referenceScene("lighter_100");
  AutoStepper stepper(scene.chain, 1e-3);
  stepper.start(scene.start);
  std::vector<std::string> used;
  for (double time = 0.0; time < 5.0; time += stepper.step()) {
    const std::string method(stepper.method());
    if (used.empty() || used.back() != method) used.push_back(method);
  }
  ASSERT_GE(used.size(), 3);
  used.resize(3);  // order 8 may return when the motion is lively
  EXPECT_EQ(used,
            (std::vector<std::string>{"Taylor-8", "Stabilized-Taylor-8", "Stabilized-Taylor-4"}));
}

std::int64_t evaluationsOf(const char* method, test::Scene scene, double tolerance,
                           double seconds) {
  const auto integrator = makeIntegrator(method, scene.chain, {tolerance, false, 1});
  integrator->advance(scene.start, seconds, 1);
  return integrator->forceEvaluations();
}

// Order 4 is the cheapest in the first milliseconds. Waiting for the next race took 46,000 evaluations.
TEST(Auto, RacesAgainWhenAMethodBecomesSlower) {
  const test::Scene scene = test::referenceScene("alternating_50");
  const std::int64_t good = evaluationsOf("Stabilized-Taylor-8", scene, 1e-5, 1.0);
  EXPECT_LT(evaluationsOf("Auto", scene, 1e-5, 1.0), 3 * good / 2);  // 13,800 and 12,100
}

// Fast vibration with little damping: accuracy limits the steps of the plain series.
TEST(Auto, LeavesThePlainSeriesInFastVibration) {
  const Eigen::Vector4d masses(0.14, 0.12, 1.07, 3.09);
  test::Scene scene{"", Chain(masses, SpringLaw{7.5e8, 7.1, 1.0}, 9.81), State(4)};
  scene.start.x() << 0.0, 0.70, 0.20, -0.26;
  scene.start.y() << 0.0, -0.71, -1.57, -2.46;
  const std::int64_t plain = evaluationsOf("Taylor-8", scene, 1e-5, 0.02);
  EXPECT_LT(evaluationsOf("Auto", scene, 1e-5, 0.02), 3 * plain / 4);  // 56,100 and 82,300
}

// On long chains an evaluation of the implicit method costs as much per particle as on short ones.
TEST(Auto, TakesTheImplicitMethodOnALongChainWithAFewLightParticles) {
  Eigen::VectorXd masses = Eigen::VectorXd::Ones(3000);
  masses.segment(1, 5).setConstant(1e-6);
  const test::Scene scene{"", Chain(masses, SpringLaw{}, 9.81), test::straightLine(3000, 1.0, 0.0)};
  EXPECT_EQ(methodAfter(scene, 1e-6, 0.01), "Radau-9");
}

// A long chain forgets the methods that are not at work; their work still counts.
TEST(Auto, HasTheSameBitsAgainAfterItForgotMethods) {
  const test::Scene light = test::referenceScene("lighter_100");
  const Eigen::Index size = 10'001;
  const test::Scene scene{
      "",
      Chain(Eigen::VectorXd::Constant(size, light.chain.masses()[1]), light.chain.spring(), 9.81),
      test::straightLine(size, 1.0, 0.0)};
  AutoStepper stepper(scene.chain, 1e-3);
  double times[2] = {};
  std::int64_t evaluations[2] = {};
  for (int start = 0; start < 2; ++start) {
    stepper.start(scene.start);
    const std::int64_t before = stepper.statistics().force_evaluations;
    for (int n = 0; n < 150; ++n) times[start] += stepper.step();
    evaluations[start] = stepper.statistics().force_evaluations - before;
  }
  EXPECT_NE(stepper.method(), "Taylor-8");
  EXPECT_EQ(times[0], times[1]);
  EXPECT_EQ(evaluations[0], evaluations[1]);
  EXPECT_EQ(stepper.report().find(", 0 switches"), std::string::npos) << stepper.report();
  EXPECT_EQ(stepper.statistics().accepted, 300);
}

TEST(Auto, ReportsWhatItUsed) {
  const test::Scene scene = test::referenceScene("feather_50");
  const auto integrator = makeIntegrator("Auto", scene.chain, {1e-2, false, 1});
  EXPECT_EQ(integrator->report(), "0 switches");
  State state = scene.start;
  integrator->advance(state, 0.1, 10);
  const std::string report = integrator->report();
  EXPECT_NE(report.find("Taylor-8 for "), std::string::npos) << report;
  EXPECT_NE(report.find("Radau-9 for "), std::string::npos) << report;
  EXPECT_NE(report.find(", 2 switches"), std::string::npos) << report;
}

TEST(Auto, KeepsItsToleranceWhereOnlyImplicitMethodsArePractical) {
  for (const char* method : {"Auto", "Radau-9"})
    for (const double tolerance : {1e-3, 1e-5}) {
      test::Scene scene = test::referenceScene("feather_50");
      makeIntegrator(method, scene.chain, {tolerance, false, 1})->advance(scene.start, 1.0, 1);
      EXPECT_LT(test::positionError(scene.start, test::referenceSolution("feather_50", 1)),
                10.0 * tolerance)  // 0.14 and 0.74 tolerances
          << method << " at " << tolerance;
    }
}

// Explicit methods overflow there, order 12 from 3e12/s on: the shortest step is beyond their limit.
TEST(Auto, TakesTheImplicitMethodAloneForExtremeDampingRates) {
  for (const double rate : {9e11, 1.1e12, 3e12, 1e13, 1e14, 1e18, 1e100})
    for (const double tolerance : {1e-2, 1e-6}) {
      const Chain plain(Eigen::Vector4d(1.0, 1e-6, 1e-6, 1e-6), {50.0, 1.0, 1.0}, 9.81);
      const test::Scene scene{"", test::inAir(plain, 1e-6 * rate), test::straightLine(4, 1.0, 0.0)};
      EXPECT_EQ(methodAfter(scene, tolerance, 1.0), "Radau-9") << rate << " " << tolerance;
    }
  // Dampers of springs make a vibration fast, too: it raced with methods that overflow.
  const Chain damped(Eigen::Vector4d(1.0, 1e-6, 1e-6, 1e-6), {50.0, 1e7, 1.0}, 9.81);
  EXPECT_EQ(methodAfter({"", damped, test::straightLine(4, 1.0, 0.0)}, 1e-6, 0.1), "Radau-9");
}

}  // namespace
}  // namespace spring_pendulum
