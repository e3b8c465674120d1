#include "simulation/expected_work.hpp"

#include "integration/work.hpp"
#include "model/chain_modes.hpp"
#include <spring_pendulum/simulation/frame_steps.hpp>

#include <cmath>

namespace spring_pendulum {
namespace {

/// Expected number of steps of an error-controlled method: about twenty per second, and more if
/// springs vibrate or stability limits the step size.
double expectedSteps(const Chain& chain, double duration) {
  const double mode = largestSpringMode(chain);  // 1/kg
  const double per_second =
      20.0 + 0.5 * std::sqrt(chain.spring().stiffness * mode) + 0.1 * largestDampingRate(chain);
  return per_second * duration;
}

}  // namespace

double expectedWork(const Scenario& scenario, const Chain& chain) {
  const Method& method = scenario.method;
  const FrameSteps frame = frameSteps(scenario);
  const double intervals =
      static_cast<double>(scenario.frames - 1) * static_cast<double>(frame.steps);
  const double steps =
      method.hasFixedStep() ? intervals : expectedSteps(chain, intervals * frame.time_step);
  return steps * method.stages *
         (method.hasFixedStep() ? kFixedStepTime.of(chain.size()) : kTaylorTime.of(chain.size()));
}

}  // namespace spring_pendulum
