#include "base/checks.hpp"
#include "base/numbers.hpp"
#include "simulation/advice/step_search.hpp"
#include "simulation/advice/trial.hpp"
#include <spring_pendulum/simulation/stability_advice.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

namespace spring_pendulum {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Allowed work of a trial after a divergence, s, see `TrialBench`.
constexpr double kRemedyWork = 0.006;

bool isStable(const Trial& trial) {
  return trial.affordable && trial.verdict.kind < VerdictKind::kGainedEnergy;
}

double stableStep(const TrialBench& bench, const Method& method, double first) {
  return largestPassingStep(first, bench.leastStep(method), bench.duration(), [&](double step) {
    return isStable(bench.run(method, step, false, VerdictKind::kGainedEnergy));
  });
}

/// Said of what cannot be judged.
constexpr std::string_view kNotJudged = "unknown, as a reference run would take too long";

/// \returns NaN if a reference run would take too long
double accurateStep(const TrialBench& bench, const Method& method, double first) {
  bool measurable = true;
  const double step =
      largestPassingStep(first, bench.leastStep(method), bench.duration(), [&](double tried) {
        if (!measurable) return false;
        const Trial trial = bench.run(method, tried, true, VerdictKind::kInaccurate);
        measurable = !trial.reference_too_costly;
        return trial.affordable && !isBad(trial.verdict.kind);
      });
  return measurable ? step : std::numeric_limits<double>::quiet_NaN();
}

double durationOf(const Scenario& scenario) {
  const FrameSteps step = frameSteps(scenario);
  return std::max(step.timeOfFrame(scenario.frames - 1), step.time_step);
}

TrialBench benchFor(const Chain& chain, const State& start, const Scenario& scenario,
                    double most_work = TrialBench::kMostWork) {
  return {chain, start, durationOf(scenario), frameSteps(scenario).timeOfFrame(1), most_work};
}

/// Formats a step size with three digits, rounded down because a larger step size may fail.
std::string digits(double step) {
  return fmt::format("{:.3g}", roundedDown(step));
}

std::string stepText(double step) {
  if (step == 0.0) return "none";
  return std::isinf(step) ? "the whole run" : digits(step) + " s";
}

/// \param step 0 if no step size of at least `least` s passed, NaN if none could be judged
std::string limitText(double step, double least) {
  if (std::isnan(step)) return std::string(kNotJudged);
  if (step > 0.0) return stepText(step);
  return fmt::format("below {} s, where runs take too long to be tried", digits(least));
}

std::string errorText(const Trial& trial) {
  const PositionError& error = trial.position_error;
  const std::string position =
      std::isnan(error.largest)
          ? "position error unknown"
          : fmt::format("largest position error {} m at t = {:.4g} s{}",
                        roundedText(error.largest, 2), error.largest_time,
                        trial.measured
                            ? ""
                            : fmt::format(" (measured until t = {:.4g} s)", error.measured_until));
  return fmt::format("{}, largest energy error {} times the energy scale", position,
                     roundedText(trial.energy_error, 2));
}

std::string linearText(const Method& method, const Chain& chain, double duration) {
  return fmt::format(
      "{}: too many particles and steps to try; linear estimate of the largest stable step size: "
      "{}\n",
      method.name, stepText(linearStepLimit(method, chain, duration)));
}

/// A method with a step size that reaches a given error.
struct Candidate {
  const Method* method = nullptr;
  double step = 0.0;  ///< s, or the tolerance in m
  std::int64_t evaluations = 0;
  double work = kUnlimited;
};

/// Largest error of a trial that passes, relative to the wanted error. The margin is needed because
/// a smaller step size or tolerance can happen to give a larger error.
constexpr double kShareOfWanted = 0.5;

bool reaches(const Trial& trial, double wanted) {
  return isStable(trial) && trial.measured &&
         trial.position_error.largest <= kShareOfWanted * wanted;
}

Candidate cheapestTolerance(const TrialBench& bench, const Method& method, double wanted) {
  for (double tolerance = wanted; tolerance > 0.005 * wanted; tolerance *= 0.1) {
    const Trial trial = bench.run(method, tolerance, true, VerdictKind::kGainedEnergy);
    if (!trial.affordable) break;
    if (reaches(trial, wanted)) {
      return {&method, tolerance, trial.evaluations, trial.work};
    }
  }
  return {};
}

/// \param most_work work of the best candidate so far; a more costly one is not searched for
Candidate cheapestStep(const TrialBench& bench, const Method& method, double first, double wanted,
                       double most_work) {
  const double least = std::max(bench.leastStep(method), bench.workOf(method, 1.0) / most_work);
  const double step = largestPassingStep(first, least, bench.duration(), [&](double tried) {
    return reaches(bench.run(method, tried, true, VerdictKind::kGainedEnergy), wanted);
  });
  if (step == 0.0 || std::isinf(step)) return {};
  const double evaluations = bench.duration() / step * method.stages;
  return {&method, step, std::llround(evaluations), bench.workOf(method, step)};
}

std::string cheapestFor(const TrialBench& bench, const Scenario& scenario) {
  Candidate best;
  const double wanted = scenario.wanted_error;
  if (bench.run(findMethod("Auto"), wanted, true).reference_too_costly) {
    return fmt::format("position error of at most {:.3g} m: {}\n", wanted, kNotJudged);
  }
  for (const StepControl control : {StepControl::kErrorControlled, StepControl::kFixed}) {
    for (const Method& method : methodTable()) {
      if (method.control != control) continue;
      const Candidate candidate =
          control == StepControl::kFixed
              ? cheapestStep(bench, method, scenario.time_step, wanted, best.work)
              : cheapestTolerance(bench, method, wanted);
      if (candidate.work < best.work) best = candidate;
    }
  }
  if (best.method == nullptr) {
    return fmt::format("no method tried keeps the position error below {:.3g} m\n", wanted);
  }
  const bool fixed = best.method->hasFixedStep();
  return fmt::format(
      "cheapest for a position error of at most {:.3g} m: {} with a {} of {} {}, {} force "
      "evaluations\n",
      wanted, best.method->name, fixed ? "step size" : "tolerance",
      fixed ? digits(best.step) : fmt::format("{:.3g}", best.step), fixed ? "s" : "m",
      best.evaluations);
}

}  // namespace

StepLimits findStepLimits(const Method& method, const Chain& chain, const State& start,
                          double first, double duration, double frame_interval) {
  requireSize(chain.size(), start.size());
  requireFinitePositive("first", first, "s");
  requireFinitePositive("duration", duration, "s");
  requireFinitePositive("frame_interval", frame_interval, "s");
  const TrialBench bench(chain, start, duration, frame_interval);
  StepLimits limits;
  limits.stable = stableStep(bench, method, first);
  if (limits.stable == 0.0) return limits;
  limits.accurate = accurateStep(bench, method, std::min(first, limits.stable));
  return limits;
}

std::string describeStability(const Chain& chain, const State& start, const Scenario& scenario) {
  requireSize(chain.size(), start.size());
  const Method& method = scenario.method;
  const bool fixed = method.hasFixedStep();
  const TrialBench bench = benchFor(chain, start, scenario);
  const double duration = bench.duration();
  const Trial trial = bench.run(method, scenario.tolerance, frameSteps(scenario),
                                std::max<std::int64_t>(scenario.frames - 1, 1), true);
  if (!trial.affordable) {
    return fixed ? linearText(method, chain, duration)
                 : fmt::format("{}: takes too long to try\n", method.name);
  }
  std::string text = fmt::format("{} with a {} of {} {} over {:.4g} s: {}\n{}\n", method.name,
                                 fixed ? "step size" : "tolerance",
                                 numberText(fixed ? scenario.time_step : scenario.tolerance),
                                 fixed ? "s" : "m", duration, trial.verdict.text, errorText(trial));
  if (fixed) {
    const StepLimits limits = findStepLimits(method, chain, start, scenario.time_step, duration,
                                             frameSteps(scenario).timeOfFrame(1));
    text += fmt::format("largest stable step size: {}\nlargest accurate step size: {}\n",
                        limitText(limits.stable, bench.leastStep(method)),
                        limitText(limits.accurate, bench.leastStep(method)));
  }
  if (scenario.wanted_error > 0.0) text += cheapestFor(bench, scenario);
  return text;
}

std::string remedyForDivergence(const Chain& chain, const State& start, const Scenario& scenario) {
  const Method& method = scenario.method;
  const TrialBench bench = benchFor(chain, start, scenario, kRemedyWork);
  std::string text;
  if (method.hasFixedStep()) {
    const double tried = stableStep(bench, method, 0.5 * scenario.time_step);
    const double step = tried > 0.0 ? tried : linearStepLimit(method, chain, bench.duration());
    text = fmt::format("largest stable step for {}: {}{}", method.name, stepText(step),
                       tried > 0.0 ? "" : " (linear estimate)");
  } else {
    text = fmt::format("try a tolerance below {} m", numberText(scenario.tolerance));
  }
  const Method& other = findMethod("Auto");
  if (&other == &method) return text;
  const bool works = isStable(bench.run(other, scenario.tolerance, false));
  return works ? fmt::format("{}; or use {}", text, other.name) : text;
}

}  // namespace spring_pendulum
