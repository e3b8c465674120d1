#include "simulation/advice/stability_warning.hpp"

#include "base/numbers.hpp"
#include "simulation/advice/linear_stability.hpp"
#include "simulation/advice/trial.hpp"
#include <spring_pendulum/simulation/stability_advice.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace spring_pendulum {
namespace {

/// Allowed work of a trial, s, see `TrialBench`.
constexpr double kTrialWork = 0.006;

}  // namespace

std::string stabilityWarning(const Chain& chain, const Scenario& scenario, const State* start) {
  const Method& method = scenario.method;
  if (!method.hasFixedStep() || scenario.frames < 2) return {};
  const FrameSteps step = frameSteps(scenario);
  const double steps = static_cast<double>(scenario.frames - 1) * static_cast<double>(step.steps);
  const std::string time_step = numberText(step.time_step);
  if (isClearlyUnstable(method, chain, step.time_step, steps)) {
    const double duration = std::min(steps * step.time_step, std::numeric_limits<double>::max());
    const double limit = linearStepLimit(method, chain, duration);
    return fmt::format(
        "{} may be unstable with a time step of {} s; {}use Auto", method.name, time_step,
        limit > 0.0 ? fmt::format("largest stable step: about {} s (linear estimate); or ",
                                  roundedText(limit, 2))
                    : "");
  }
  if (start == nullptr) return {};
  const TrialBench bench(chain, *start, step.timeOfFrame(scenario.frames), step.timeOfFrame(1),
                         kTrialWork);
  const std::int64_t frames = std::min(scenario.frames - 1, bench.affordableFrames(method, step));
  const Trial trial =
      bench.run(method, scenario.tolerance, step, frames, false, VerdictKind::kGainedEnergy);
  if (trial.verdict.kind < VerdictKind::kGainedEnergy) return {};
  return fmt::format("{} is unstable with a time step of {} s ({}); {}", method.name, time_step,
                     trial.verdict.text, remedyForDivergence(chain, *start, scenario));
}

}  // namespace spring_pendulum
