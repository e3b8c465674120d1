// A recorded coarse map of stability: the verdict by step size and properties of the chain.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "support/verdict_of_run.hpp"

namespace spring_pendulum {
namespace {

/// A word a step, the largest first; a letter a value. `.` ok, `d` drift, `g` gained energy,
/// `X` diverged. Values lie between the borders, so that the map does not hang on rounding.
std::string mapOf(const char* method, const std::vector<double>& values,
                  const std::function<test::Scene(double)>& scene) {
  std::string map;
  for (const double step : {0.5, 0.15, 0.05, 0.015, 0.005, 0.0015}) {
    if (!map.empty()) map += " ";
    for (const double value : values) {
      const Verdict verdict = test::verdictOfRun(scene(value), findMethod(method), step, 5.0, true);
      map += "....dgX"[static_cast<int>(verdict.kind)];
    }
  }
  return map;
}

test::Scene withMass(double mass) {
  return test::horizontalChain("", 11, mass);
}

test::Scene withDamping(double damping) {
  return test::horizontalChain("", 11, 1.0, {50.0, damping, 1.0});
}

const std::vector<double> kMasses{1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0};
const std::vector<double> kDampings{0.0, 0.1, 1.0, 10.0, 100.0, 1000.0};

TEST(StabilityMap, OfStepAgainstMass) {
  EXPECT_EQ(mapOf("Euler", kMasses, withMass), "XXXXXg XXXXXd XXXXg. XXXXd. XXgd.. Xgdd..");
  EXPECT_EQ(mapOf("Runge-Kutta-2", kMasses, withMass), "XXXXX. XXXX.. XXXd.. XX.... X..... X.....");
  EXPECT_EQ(mapOf("Runge-Kutta-4", kMasses, withMass), "XXXX.. XXXd.. XXd... XX.... X..... X.....");
}

TEST(StabilityMap, OfStepAgainstDamping) {
  EXPECT_EQ(mapOf("Euler", kDampings, withDamping), "XXXXXX XXXXXX XXXXXX XXXdXX ggdddX gddd.X");
  EXPECT_EQ(mapOf("Runge-Kutta-2", kDampings, withDamping),
            "XXXXXX XXXXXX ggddXX ....XX .....X .....X");
  EXPECT_EQ(mapOf("Runge-Kutta-4", kDampings, withDamping),
            "XXXXXX dddXXX ....XX ....XX .....X .....X");
}

}  // namespace
}  // namespace spring_pendulum
