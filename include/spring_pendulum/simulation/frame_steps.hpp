// From one frame to the next: the two arguments of Integrator::advance that do so.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/export.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

namespace SPRING_PENDULUM_API spring_pendulum {

struct FrameSteps {
  double time_step = 0.0;  ///< s
  std::int64_t steps = 0;

  /// Time of a frame in s, t = n·Δt with an integer n.
  double timeOfFrame(std::int64_t frame) const {
    return static_cast<double>(frame * steps) * time_step;
  }
};

/// A fixed-step method takes its steps; an error-controlled one, which chooses its own, is only
/// told when the next frame is due.
inline FrameSteps frameSteps(const Scenario& scenario) {
  if (findMethod(scenario.method).control == StepControl::kFixed) {
    return {scenario.time_step, scenario.steps_per_frame};
  }
  return {scenario.frame_interval, 1};
}

}  // namespace spring_pendulum
