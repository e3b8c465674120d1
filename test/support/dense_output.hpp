// How exactly a stepper knows the motion inside a step.
#pragma once

#include "integration/error_control/dense_output_stepper.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <cmath>

#include <support/reference.hpp>

namespace spring_pendulum::test {

/// Position error of the dense output at 0.4 of the first step that ends behind 0.5 s, for the
/// state at its beginning, and the length of that step.
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
  stepper.interpolate(0.0, exact);
  stepper.interpolate(0.4, inside);
  makeIntegrator("Runge-Kutta-4", scene.chain)->advance(exact, 0.4 * step / 1000, 1000);
  return {positionError(inside, exact), step};
}

/// Order of the dense output: the error of one step grows with a power one higher.
/// \param make_stepper makes one from a tolerance in m
template <typename MakeStepper>
double denseOutputOrder(const Scene& scene, double coarse, double fine,
                        const MakeStepper& make_stepper) {
  const InsideOfStep a = insideOfStep(*make_stepper(coarse), scene);
  const InsideOfStep b = insideOfStep(*make_stepper(fine), scene);
  return std::log(a.error / b.error) / std::log(a.step / b.step) - 1.0;
}

}  // namespace spring_pendulum::test
