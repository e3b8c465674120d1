// Accuracy of the dense output of a stepper.
#pragma once

#include "integration/error_control/dense_output_stepper.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <cmath>

#include <support/reference.hpp>

namespace spring_pendulum::test {

/// Returns the position error of the dense output at 0.4 of the first step after 0.5 s, and the step size.
struct InsideOfStep {
  double error;
  double step;
};

inline InsideOfStep insideOfStep(DenseOutputStepper& stepper, const Scene& scene) {
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
/// \param make_stepper makes a stepper from a tolerance in m
template <typename MakeStepper>
double denseOutputOrder(const Scene& scene, double coarse, double fine,
                        const MakeStepper& make_stepper) {
  const InsideOfStep a = insideOfStep(*make_stepper(coarse), scene);
  const InsideOfStep b = insideOfStep(*make_stepper(fine), scene);
  return std::log(a.error / b.error) / std::log(a.step / b.step) - 1.0;
}

}  // namespace spring_pendulum::test
