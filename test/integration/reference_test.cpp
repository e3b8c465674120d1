// The three methods of the exercise against exact solutions.
#include "support/reference.hpp"

#include "integration/fixed_step/plain_runge_kutta.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "own_methods.hpp"

namespace spring_pendulum::test {
namespace {

/// Largest position error of a method after `seconds`, with `steps_per_second` steps.
double errorAfter(Integrator& integrator, const Scene& scene, const std::string& name, int seconds,
                  int steps_per_second) {
  State state = scene.start;
  integrator.advance(state, 1.0 / steps_per_second, std::int64_t{seconds} * steps_per_second);
  return positionError(state, referenceSolution(name, seconds));
}

struct KnownError {
  const char* method;
  int seconds;
  double error;  ///< m, computed independently of this package
};

constexpr KnownError kKnownErrors[] = {
    {"Euler", 1, 4.91e-2},         {"Euler", 2, 1.36e-1},          {"Euler", 5, 1.13},
    {"Euler", 10, 3.05},           {"Runge-Kutta-2", 1, 7.32e-4},  {"Runge-Kutta-2", 2, 2.30e-3},
    {"Runge-Kutta-2", 5, 9.82e-3}, {"Runge-Kutta-2", 10, 3.73e-2}, {"Runge-Kutta-4", 1, 2.58e-7},
    {"Runge-Kutta-4", 2, 1.09e-6}, {"Runge-Kutta-4", 5, 5.93e-6},  {"Runge-Kutta-4", 10, 2.28e-5},
    {"Runge-Kutta-4", 20, 9.79e-5}};

// On horizontal_11 with a step of 0.01 s, within 1 % of each number.
TEST(KnownError, Agrees) {
  const Scene scene = referenceScene("horizontal_11");
  for (const auto& [method, seconds, error] : kKnownErrors) {
    const auto integrator = makeIntegrator(method, scene.chain);
    EXPECT_NEAR(errorAfter(*integrator, scene, "horizontal_11", seconds, 100), error, 0.01 * error)
        << method << " after " << seconds << " s";
  }
}

/// log2 of the ratio of the errors with a step and with half of it.
double slope(Integrator& integrator, const std::string& name, int seconds, int steps_per_second) {
  const Scene scene = referenceScene(name);
  const double coarse = errorAfter(integrator, scene, name, seconds, steps_per_second);
  return std::log2(coarse / errorAfter(integrator, scene, name, seconds, 2 * steps_per_second));
}

/// Steps per second that are enough to show the order when the step is halved.
int stepsPerSecond(const Method& method) {
  return method.order == 1 ? 8192 : 512;
}

TEST(Order, IsTheSlopeOfTheErrorFromBothSides) {
  registerOwnMethods();
  for (const Method& method : methodTable()) {
    if (!method.hasFixedStep()) continue;
    for (const char* scene_name : {"single_vertical", "two_masses_45deg"}) {
      const Scene scene = referenceScene(scene_name);
      const auto integrator = makeIntegrator(method, scene.chain);
      EXPECT_NEAR(slope(*integrator, scene_name, 2, stepsPerSecond(method)), method.order, 0.1)
          << method.name << " on " << scene_name;
    }
  }
}

TEST(Order, IsLostWithOneAlteredCoefficient) {
  for (const Method& method : methodTable()) {
    if (!method.hasFixedStep() || method.tableau == nullptr) continue;
    ButcherTableau altered = *method.tableau;
    altered.b[0] += 0.01;
    for (const char* scene_name : {"single_vertical", "two_masses_45deg"}) {
      const Scene scene = referenceScene(scene_name);
      PlainRungeKutta integrator(scene.chain, altered, false);
      EXPECT_LT(slope(integrator, scene_name, 2, stepsPerSecond(method)), method.order - 0.5)
          << method.name << " on " << scene_name;
    }
  }
}

// A damped harmonic oscillation about the equilibrium length L_0 + m g/k_s, in closed form.
TEST(Order, HoldsAgainstTheClosedFormOfOneSpring) {
  const Scene scene = referenceScene("single_vertical");
  const double equilibrium = -(1.0 + 9.81 / 50.0);
  const double amplitude = -1.3 - equilibrium, decay = 0.5;
  const double frequency = std::sqrt(50.0 - decay * decay), t = 2.0;
  const double exact =
      equilibrium + amplitude * std::exp(-decay * t) *
                        (std::cos(frequency * t) + decay / frequency * std::sin(frequency * t));
  EXPECT_NEAR(referenceSolution("single_vertical", 2).y()[1], exact, 1e-14);
  for (const Method& method : methodTable()) {
    if (!method.hasFixedStep()) continue;
    const auto integrator = makeIntegrator(method, scene.chain);
    double errors[2] = {};
    for (int halvings = 0; halvings < 2; ++halvings) {
      const int steps = 2 * stepsPerSecond(method) << halvings;
      State state = scene.start;
      integrator->advance(state, t / steps, steps);
      errors[halvings] = std::abs(state.y()[1] - exact);
    }
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), method.order, 0.1) << method.name;
  }
}

}  // namespace
}  // namespace spring_pendulum::test
