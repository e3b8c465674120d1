#include "base/checks.hpp"
#include "base/numbers.hpp"
#include "simulation/advice/linear_stability.hpp"
#include "simulation/advice/step_search.hpp"
#include "simulation/advice/trial.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/integration/smallest_tolerance.hpp>
#include <spring_pendulum/simulation/stability_advice.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace spring_pendulum {
namespace {

/// Work in s allowed for a trial at the start of a run and after a divergence, see `TrialBench`.
constexpr double kShortWork = 0.006;
/// Largest error of a trial that passes, relative to the wanted error. The margin is needed because
/// a smaller step size or tolerance can happen to give a larger error.
constexpr double kShareOfWanted = 0.5;
/// Said of what cannot be judged.
constexpr const char* kNotJudged = "unknown, as a reference run would take too long";
constexpr const char* kNotTried = "unknown, as runs take too long to be tried";

/// Whether the true positions were known to the end of a trial, or were too sensitive to be known.
bool isJudged(const Trial& trial) {
  return trial.finished && (trial.measured || trial.verdict.kind == VerdictKind::kSensitive);
}

/// \returns NaN if the search would take too long
double stableStep(const TrialBench& bench, const Method& method, double first) {
  const double limit =
      largestPassingStep(first, bench.leastStep(method), bench.duration(), [&](double step) {
        return bench.run(method, step, ReferenceUse::kNever, VerdictKind::kGainedEnergy).isStable();
      });
  return bench.isExhausted() ? std::numeric_limits<double>::quiet_NaN() : limit;
}

/// \returns NaN if a reference run would take too long
double accurateStep(const TrialBench& bench, const Method& method, double first) {
  bool measurable = true;
  const double step =
      largestPassingStep(first, bench.leastStep(method), bench.duration(), [&](double tried) {
        if (!measurable) return false;
        const Trial trial = bench.run(method, tried, ReferenceUse::kAuto, VerdictKind::kInaccurate);
        measurable = isJudged(trial) || !trial.isStable();
        return trial.finished && !isBad(trial.verdict.kind);
      });
  return measurable && !bench.isExhausted() ? step : std::numeric_limits<double>::quiet_NaN();
}

StepLimits stepLimits(const TrialBench& bench, const Method& method, double first) {
  StepLimits limits;
  limits.stable = stableStep(bench, method, first);
  if (limits.stable == 0.0) return limits;
  limits.accurate = accurateStep(bench, method, std::min(first, limits.stable));
  return limits;
}

/// Returns a finite duration in s of at least one step.
double durationOf(const Scenario& scenario) {
  const FrameSteps step = frameSteps(scenario);
  return std::clamp(step.timeOfFrame(scenario.frames - 1), step.time_step,
                    std::numeric_limits<double>::max());
}

TrialBench benchFor(const Chain& chain, const State& start, const Scenario& scenario,
                    double most_work = TrialBench::kMostWork,
                    const std::function<bool()>& stop = {}) {
  return {chain, start, durationOf(scenario), frameSteps(scenario).timeOfFrame(1), stop, most_work};
}

std::string stepText(double step) {
  if (step == 0.0) return "none";
  return std::isinf(step) ? "the whole run" : fmt::format("{:.3g} s", roundedDown(step));
}

/// \param step 0 if no step size of at least `least` s passed
std::string limitText(double step, double least) {
  if (step > 0.0) return stepText(step);
  return std::isinf(least)
             ? kNotTried
             : fmt::format("below {}, where runs take too long to be tried", stepText(least));
}

/// "step size of 0.01 s" or "tolerance of 1e-06 m"
std::string settingText(const Method& method, const std::string& setting) {
  return fmt::format(method.hasFixedStep() ? "step size of {} s" : "tolerance of {} m", setting);
}

/// Returns the largest step size or tolerance of a method that reaches the wanted error; 0: none.
double settingFor(const TrialBench& bench, const Method& method, double first, double wanted) {
  const auto reaches = [&](double setting) {
    const Trial trial = bench.run(method, setting, ReferenceUse::kAuto, VerdictKind::kGainedEnergy);
    return trial.isStable() && trial.measured &&
           trial.position_error.largest + trial.position_error.uncertainty <=
               kShareOfWanted * wanted;
  };
  if (method.hasFixedStep()) {
    return largestPassingStep(first, bench.leastStep(method), bench.duration(), reaches);
  }
  for (const double tolerance : {wanted, 0.1 * wanted, 0.01 * wanted}) {
    if (tolerance >= bench.leastTolerance() && reaches(tolerance)) return tolerance;
  }
  return 0.0;
}

std::string cheapestFor(TrialBench bench, double first, double wanted) {
  std::string text =
      fmt::format("no method tried keeps the position error below {:.3g} m\n", wanted);
  if (wanted < bench.leastTolerance()) return text;
  if (!isJudged(bench.run(findMethod("Auto"), wanted, ReferenceUse::kAuto))) {
    return fmt::format("position error of at most {:.3g} m: {}\n", wanted, kNotJudged);
  }
  for (const StepControl control : {StepControl::kErrorControlled, StepControl::kFixed}) {
    for (const Method& method : methodTable()) {
      if (method.control != control) continue;
      const double setting = settingFor(bench, method, first, wanted);
      if (setting == 0.0 || std::isinf(setting)) continue;
      const Trial trial = bench.run(method, setting, ReferenceUse::kNever);
      if (trial.work >= bench.mostWork()) continue;
      bench.limitWork(trial.work);  // of cheaper methods
      text = fmt::format(
          "cheapest for a position error of at most {:.3g} m: {} with a {}, {} force evaluations\n",
          wanted, method.name, settingText(method, fmt::format("{:.3g}", setting)),
          trial.evaluations);
    }
  }
  if (!bench.isExhausted()) return text;
  return fmt::format("position error of at most {:.3g} m: {}\n", wanted, kNotTried);
}

}  // namespace

StepLimits findStepLimits(const Method& method, const Chain& chain, const State& start,
                          double first, double duration, double frame_interval) {
  requireSize(chain.size(), start.size());
  requireFinitePositive("first", first, "s");
  requireFinitePositive("duration", duration, "s");
  requireFinitePositive("frame_interval", frame_interval, "s");
  if (!method.hasFixedStep()) {
    throw InputError(
        fmt::format("{} has no step size to find: it is error-controlled", method.name));
  }
  return stepLimits(TrialBench(chain, start, duration, frame_interval), method, first);
}

StabilityReport checkStability(const Chain& chain, const State& start, const Scenario& scenario,
                               const std::function<bool()>& stop) {
  requireSize(chain.size(), start.size());
  checkScenario(scenario);
  const Method& method = scenario.method;
  const bool fixed = method.hasFixedStep();
  const TrialBench bench = benchFor(chain, start, scenario, TrialBench::kMostWork, stop);
  const double least = fixed ? bench.leastStep(method) : 0.0;
  StabilityReport report;
  Trial trial;
  if (!fixed || scenario.time_step >= least) trial = bench.run(scenario, ReferenceUse::kAuto);
  if (!trial.finished) {
    report.text = fmt::format("{}: takes too long to try\n", method.name);
    if (!fixed) return report;
    report.limits.stable = linearStepLimit(method, chain, bench.duration());
    report.text = fmt::format(
        "{}: too many particles and steps to try; linear estimate of the largest stable step size: "
        "{}\n",
        method.name, stepText(report.limits.stable));
    return report;
  }
  report.tried = true;
  report.verdict = trial.verdict;
  report.position_error = trial.position_error;
  report.text =
      fmt::format("{} with a {} over {:.4g} s: {}\n{}\n", method.name,
                  settingText(method, numberText(fixed ? scenario.time_step : scenario.tolerance)),
                  bench.duration(), trial.verdict.text, trial.measurements);
  if (fixed) {
    report.limits = stepLimits(bench, method, scenario.time_step);
    report.text += fmt::format(
        "largest stable step size: {}\nlargest accurate step size: {}\n",
        std::isnan(report.limits.stable) ? kNotTried : limitText(report.limits.stable, least),
        std::isnan(report.limits.accurate) ? kNotJudged : limitText(report.limits.accurate, least));
  }
  if (scenario.wanted_error > 0.0) {
    const double first = fixed ? scenario.time_step : Scenario{}.time_step;
    report.text += cheapestFor(bench, first, scenario.wanted_error);
  }
  return report;
}

std::string stabilityWarning(const Chain& chain, const Scenario& scenario, const State* start) {
  checkScenario(scenario);
  const Method& method = scenario.method;
  if (!method.hasFixedStep() || scenario.frames < 2) return {};
  const double duration = durationOf(scenario);
  const std::string time_step = numberText(scenario.time_step);
  if (isClearlyUnstable(method, chain, scenario.time_step, duration)) {
    const double limit = linearStepLimit(method, chain, duration);
    return fmt::format(
        "{} may be unstable with a time step of {} s; {}use Auto", method.name, time_step,
        limit > 0.0 ? fmt::format("largest stable step: about {} s (linear estimate); or ",
                                  roundedText(limit, 2))
                    : "");
  }
  if (start == nullptr) return {};
  const Trial trial = benchFor(chain, *start, scenario, kShortWork)
                          .run(scenario, ReferenceUse::kNever, VerdictKind::kGainedEnergy);
  if (trial.verdict.kind < VerdictKind::kGainedEnergy) return {};
  return fmt::format("{} is unstable with a time step of {} s ({}); {}", method.name, time_step,
                     trial.verdict.text, remedyForDivergence(chain, *start, scenario));
}

std::string remedyForDivergence(const Chain& chain, const State& start, const Scenario& scenario,
                                const std::function<bool()>& stop) {
  requireSize(chain.size(), start.size());
  checkScenario(scenario);
  const Method& method = scenario.method;
  const TrialBench bench = benchFor(chain, start, scenario, kShortWork, stop);
  std::string text = fmt::format("try a tolerance below {} m", numberText(scenario.tolerance));
  if (method.hasFixedStep()) {
    const double tried = stableStep(bench, method, 0.5 * scenario.time_step);
    const double step = tried > 0.0 ? tried : linearStepLimit(method, chain, bench.duration());
    text = fmt::format("largest stable step for {}: {}{}", method.name, stepText(step),
                       tried > 0.0 ? "" : " (linear estimate)");
  }
  const Method& other = findMethod("Auto");
  const double tolerance = method.hasFixedStep() ? Scenario{}.tolerance : scenario.tolerance;
  if (&other != &method && bench
                               .run(other, std::max(tolerance, bench.leastTolerance()),
                                    ReferenceUse::kNever, VerdictKind::kGainedEnergy)
                               .isStable()) {
    text += "; or use Auto";
  }
  return stop && stop() ? "" : text;
}

}  // namespace spring_pendulum
