// Accuracy of the dense output of steppers.
#include "integration/implicit/radau_stepper.hpp"
#include "integration/taylor/stabilized_taylor_stepper.hpp"
#include "integration/taylor/taylor_stepper.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include "support/reference.hpp"

namespace spring_pendulum::test {
namespace {

/// The position error of the dense output at 0.4 of the first step after 0.5 s, and the step size.
struct InsideOfStep {
  double error;
  double step;
};

InsideOfStep insideOfStep(DenseOutputStepper&& stepper, const Scene& scene) {
  stepper.start(scene.start);
  for (double time = 0.0; time < 0.5;) time += stepper.step();
  const double step = stepper.statistics().last_step;
  State exact = scene.start;
  State inside = scene.start;
  exact.values() = stepper.stateAt(0.0).values();
  inside.values() = stepper.stateAt(0.4).values();
  makeIntegrator("Runge-Kutta-4", scene.chain)->advance(exact, 0.4 * step / 1000, 1000);
  return {positionError(inside, exact), step};
}

/// Returns the order p of the dense output, whose local error is O(h^(p+1)).
template <typename Stepper, int... kOrder>
double orderOf(const char* name, double coarse, double fine) {
  const Scene scene = referenceScene(name);
  const InsideOfStep a = insideOfStep(Stepper(scene.chain, kOrder..., coarse), scene);
  const InsideOfStep b = insideOfStep(Stepper(scene.chain, kOrder..., fine), scene);
  return std::log(a.error / b.error) / std::log(a.step / b.step) - 1.0;
}

TEST(DenseOutput, HasTheOrderOfTheMethodOrOfItsStages) {
  EXPECT_NEAR((orderOf<TaylorStepper, 4>("two_masses_45deg", 1.0, 1e-3)), 5.0, 0.2);         // 4.96
  EXPECT_NEAR((orderOf<TaylorStepper, 6>("two_masses_45deg", 1.0, 1e-3)), 7.0, 0.2);         // 6.90
  EXPECT_NEAR((orderOf<TaylorStepper, 8>("two_masses_45deg", 1.0, 1e-3)), 9.0, 0.2);         // 8.92
  EXPECT_NEAR((orderOf<StabilizedTaylorStepper, 4>("horizontal_11", 1.0, 1e-3)), 4.0, 0.4);  // 3.97
  EXPECT_NEAR((orderOf<StabilizedTaylorStepper, 8>("horizontal_11", 1.0, 1e-3)), 8.0, 0.8);  // 7.76
  EXPECT_NEAR(orderOf<RadauStepper>("horizontal_11", 1e-4, 1e-7), 5.0, 0.6);
}

}  // namespace
}  // namespace spring_pendulum::test
