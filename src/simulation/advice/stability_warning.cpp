#include "simulation/advice/stability_warning.hpp"

#include "base/numbers.hpp"
#include "model/chain_modes.hpp"
#include "simulation/advice/trial.hpp"
#include <spring_pendulum/simulation/stability_advice.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

/// A method is clearly unstable if an oscillation grows by kClearGrowth within kSteps steps.
constexpr double kClearGrowth = 1e8;
constexpr std::int64_t kSteps = 500;

/// Allowed work of a trial, see `TrialBench`: about 0.02 s.
constexpr double kTrialWork = 2e6;

/// Whether the method is clearly unstable for a single spring with the rate of the stiffest spring
/// of the chain.
bool isClearlyUnstable(const Method& method, const Chain& chain, const Scenario& scenario) {
  const double mode = stiffestSpring(chain);
  const SpringLaw spring{scenario.stiffness * mode, scenario.damping * mode, 1.0};
  const double rate = std::max(std::sqrt(spring.stiffness), spring.damping);
  if (!(rate > 0.0) || !std::isfinite(rate)) return false;
  const Chain single(Eigen::Vector2d::Ones(), spring, 0.0);
  State state(2);
  state.x()[1] = 1.125;
  state.vx()[1] = 0.125 * rate;
  const double steps =
      static_cast<double>(scenario.frames - 1) * static_cast<double>(scenario.steps_per_frame);
  makeIntegrator(method, single)
      ->advance(state, scenario.time_step,
                static_cast<std::int64_t>(std::min(steps, static_cast<double>(kSteps))));
  const double size = std::max(std::abs(state.x()[1] - 1.0), std::abs(state.vx()[1]) / rate);
  return !(size < 0.125 * kClearGrowth);
}

}  // namespace

std::string stabilityWarning(const Chain& chain, const Scenario& scenario) {
  const Method& method = scenario.method;
  if (!method.hasFixedStep() || scenario.frames < 2) return {};
  if (!isClearlyUnstable(method, chain, scenario)) return {};
  const FrameSteps step = frameSteps(scenario);
  const double limit = linearStepLimit(method, chain, step.timeOfFrame(scenario.frames - 1));
  return fmt::format("{} may be unstable with a time step of {} s; {}or use Auto", method.name,
                     numberText(scenario.time_step),
                     limit > 0.0
                         ? fmt::format("largest stable step: about {} s (linear estimate); ",
                                       roundedText(limit, 2))
                         : "");
}

std::string stabilityWarning(const Chain& chain, const State& start, const Scenario& scenario) {
  std::string warning = stabilityWarning(chain, scenario);
  const Method& method = scenario.method;
  if (!warning.empty() || !method.hasFixedStep()) return warning;
  const FrameSteps step = frameSteps(scenario);
  const TrialBench bench(chain, start, step.timeOfFrame(scenario.frames), step.timeOfFrame(1),
                         kTrialWork);
  const std::int64_t frames = std::min(scenario.frames - 1, bench.affordableFrames(method, step));
  const Trial trial =
      bench.run(method, scenario.tolerance, step, frames, false, VerdictKind::kGainedEnergy);
  if (trial.verdict.kind < VerdictKind::kGainedEnergy) return {};
  return fmt::format("{} is unstable with a time step of {} s ({}); {}", method.name,
                     numberText(scenario.time_step), trial.verdict.text,
                     remedyForDivergence(chain, start, scenario));
}

}  // namespace spring_pendulum
