// The arguments of Integrator::advance that lead from one frame to the next.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#pragma GCC visibility push(default)
namespace spring_pendulum {

struct FrameSteps {
  double time_step = 0.0;  ///< s
  std::int64_t steps = 0;

  /// Returns the time of a frame in s, t = n·Δt with an integer n.
  double timeOfFrame(std::int64_t frame) const {
    return static_cast<double>(frame * steps) * time_step;
  }
};

/// Returns the steps of a fixed-step method, or the frame interval as one step for an
/// error-controlled method, which chooses its own steps.
inline FrameSteps frameSteps(const Scenario& scenario) {
  if (scenario.method.get().hasFixedStep()) return {scenario.time_step, scenario.steps_per_frame};
  return {scenario.frame_interval, 1};
}

}  // namespace spring_pendulum
#pragma GCC visibility pop
