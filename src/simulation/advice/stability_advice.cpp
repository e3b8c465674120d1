#include "base/checks.hpp"
#include "base/numbers.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include "simulation/advice/linear_stability.hpp"
#include "simulation/judge.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/stability_advice.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace spring_pendulum {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Ratio of the step sizes between which a search ends.
constexpr double kPrecision = 1.02;
/// Work in s allowed for a trial, without its reference run.
constexpr double kTrialWork = 0.1;
/// Work allowed for all trials with their reference runs, in trials.
constexpr double kMostTrials = 30.0;
/// Nominal time in s of judging a frame, per particle, and of an evaluation in code without a fast
/// kernel, beyond what the integrator counts. Measured: 25 ns, and 320 to 470 ns for 6 particles.
constexpr double kFrameTime = 2.5e-8;
constexpr double kPlainTime = 4e-7;

/// Rounds down to three significant digits; `largestSpringMode` is 1e-4 too large at most.
double roundedDown(double step) {
  const double unit = std::pow(10.0, std::floor(std::log10(step)) - 2.0);
  return std::isnormal(unit) ? std::floor(step / unit * (1.0 + 1e-4)) * unit : step;
}

/// Simulated time of a run, s.
double durationOf(const Plan& plan) {
  return std::clamp(plan.timeOfFrame(plan.frames - 1), plan.step(), 1e300);
}

/// A run to its end.
struct Trial {
  bool judged;  ///< whether the true positions were known, or are too sensitive to be known
  Verdict verdict;
  PositionError position_error;
  std::string measurements;

  bool isStable() const { return verdict.kind < VerdictKind::kGainedEnergy; }
};

/// Trial runs of a scene.
class Trials {
 public:
  Trials(const Chain& chain, const State& start, const Plan& plan, std::function<bool()> stop = {})
      : plan_(plan), scene_{chain.masses(), start, 0, chain.constants()}, stop_(std::move(stop)) {
    requireSize(chain.size(), start.size());
    checkPlan(plan);
    plan_.on_divergence = OnDivergence::kStop;
    plan_.threads = 1;
    plan_.sleep = 0.0;
    interval_ = plan_.timeOfFrame(1);
    duration_ = durationOf(plan_);
    const Method& method = plan_.method;
    const bool has_kernel = method.tableau != nullptr && chain.isPlain() &&
                            findAdvanceKernel(fastestChainKernels(), *method.tableau) != nullptr;
    evaluation_time_ = method.hasFixedStep() && !has_kernel ? kPlainTime : 0.0;
  }

  /// That of the constructor with the options of the trials.
  const Plan& plan() const { return plan_; }
  double duration() const { return duration_; }
  const State& start() const { return scene_.state; }
  bool isExhausted() const { return total_work_ >= kMostTrials * kTrialWork || (stop_ && stop_()); }

  /// Runs a variant of `plan()` until the verdict is `enough` or worse.
  /// \returns nothing if the allowed work was used up, or the trial was stopped
  std::optional<Trial> run(const Plan& plan, ReferenceUse reference,
                           VerdictKind enough = VerdictKind::kDiverged) {
    if (isExhausted()) return {};
    Plan tried = plan;
    tried.reference = reference;
    const Integrator* counted = nullptr;
    double frames = 0.0;
    const auto work = [&] {
      return counted->work() + evaluation_time_ * static_cast<double>(counted->forceEvaluations()) +
             frames * kFrameTime * (static_cast<double>(scene_.state.size()) + 10.0);
    };
    // The negated comparison also ends a method whose work is not a number.
    Run run(scene_, tried,
            {false, 0.0, [&] { return !(work() < kTrialWork) || (stop_ && stop_()); }});
    counted = &run.integrator();
    while (run.advance() && run.verdict().kind < enough) ++frames;
    total_work_ += work() + run.referenceWork();
    const bool is_known =
        run.referenceState() != nullptr || run.verdict().kind == VerdictKind::kSensitive;
    if (run.wasStopped()) return {};
    return Trial{is_known, run.verdict(), run.positionError(), run.measurements()};
  }

  /// A run with another step size, with frames at about the same times.
  std::optional<Trial> runWithStep(double step, ReferenceUse reference, VerdictKind enough) {
    constexpr double kMostFrames = 2000.0;
    constexpr double kMostSteps = 1e9;
    if (duration_ / step > kMostSteps) return {};
    const double interval = std::clamp(interval_, duration_ / kMostFrames, duration_);
    Plan plan = plan_;
    plan.time_step = step;
    plan.steps_per_frame = std::max<std::int64_t>(1, std::llround(interval / step));
    const double frames = std::round(duration_ / plan.timeOfFrame(1));
    plan.frames = static_cast<std::int64_t>(std::clamp(frames, 1.0, 1e9)) + 1;
    return run(plan, reference, enough);
  }

 private:
  Plan plan_;
  Scene scene_;
  std::function<bool()> stop_;
  double interval_ = 0.0;         ///< between frames, s
  double duration_ = 0.0;         ///< s
  double evaluation_time_ = 0.0;  ///< in addition to what the integrator counts, s
  double total_work_ = 0.0;       ///< s
};

/// Returns the largest step size up to `most` that passes, within 2 % and with three digits: `first` if it
/// passes and a slightly larger one does not. 0.95, 0.9, 0.8 and 0.65 times the result pass, too.
/// \param failed a step size known to fail, or infinite
/// \param passes nothing if the step size, and so each smaller one, takes too long to be tried
/// \returns infinity if all pass, 0 if none of those tried
double largestPassingStep(double first, double most, double failed,
                          const std::function<std::optional<bool>(double)>& passes) {
  double found = 0.0;
  double low = 0.0;  // passes or takes too long
  double stride = kPrecision;
  double step = roundedDown(std::min({first, most, failed / kPrecision}));
  for (double ratio = kPrecision; step > low && step < failed; ratio *= ratio) {
    const std::optional<bool> passed = passes(step);
    if (!passed && std::isinf(failed)) return found;
    if (passed == true) found = step;
    if (passed == true && step >= roundedDown(most)) return kInfinity;
    (passed == false ? failed : low) = step;
    if (failed <= kPrecision * low) {
      // Nearly undamped chains have narrow intervals of unstable step sizes; below each, the stride
      // grows.
      for (const double share : {0.95, 0.9, 0.8, 0.65}) {
        if (found == 0.0 || passes(share * low) != false) continue;
        failed = share * low;
        low = found = 0.0;
        ratio = stride *= stride;
      }
      if (low > 0.0) break;
    }
    const bool is_between = low > 0.0 && std::isfinite(failed);
    step = roundedDown(is_between  ? std::sqrt(low * failed)
                       : low > 0.0 ? std::min(low * ratio, most)
                                   : failed / ratio);
  }
  return found;
}

StableStep stableStep(Trials& trials, const Chain& chain, const Plan& plan) {
  const Method& method = plan.method;
  if (!method.hasFixedStep()) return {};
  // Without damping, some methods gain energy with every step size: only trials tell how much.
  const bool has_limit = method.imaginary_stability_limit > 0.0 || chain.isDissipative();
  const double found = largestPassingStep(
      has_limit ? springStepLimit(method, chain, trials.duration()) : trials.duration(),
      trials.duration(), kInfinity, [&](double step) -> std::optional<bool> {
        const auto trial =
            trials.runWithStep(step, ReferenceUse::kNever, VerdictKind::kGainedEnergy);
        return trial ? std::optional(trial->isStable()) : std::nullopt;
      });
  if (found > 0.0) return {found, false};
  const double limit = linearStepLimit(method, chain, trials.duration());
  return {std::isfinite(limit) ? roundedDown(limit) : limit, true};
}

/// Returns the largest step size without a bad verdict, up to the stable one.
/// \param trial of the plan, whose error grows with a power of the step size: the order of the method
/// \returns NaN if a reference run would take too long
double accurateStep(Trials& trials, const Chain& chain, const Plan& plan, const Trial& trial,
                    double stable) {
  const Method& method = plan.method;
  const double allowed = Judge::kInaccurateThreshold * chainLength(chain, trials.start());
  const double error = trial.position_error.largest;
  const double factor = std::pow(allowed / error, 1.0 / std::max(method.order, 1));
  double failed = kInfinity;
  if (isBad(trial.verdict.kind)) failed = plan.time_step;
  bool is_judged = true;
  const double found = largestPassingStep(
      std::isfinite(error) ? plan.time_step * factor : plan.time_step,
      std::min(stable, trials.duration()), failed, [&](double step) -> std::optional<bool> {
        const auto tried = trials.runWithStep(step, ReferenceUse::kAuto, VerdictKind::kInaccurate);
        if (!tried) return std::nullopt;
        is_judged = is_judged && (tried->judged || !tried->isStable());
        return is_judged ? std::optional(!isBad(tried->verdict.kind)) : std::nullopt;
      });
  if (!is_judged) return kNan;
  return std::isinf(found) ? stable : found;
}

std::string stepText(double step) {
  if (std::isnan(step)) return "unknown, as a reference run would take too long";
  if (step == 0.0) return "unknown, as runs take too long to be tried";
  return std::isinf(step) ? "the whole run" : fmt::format("{:.3g} s", step);
}

std::string textOf(const StableStep& stable) {
  return stepText(stable.step) +
         (stable.is_estimate && stable.step > 0.0 ? " (linear estimate)" : "");
}

}  // namespace

StableStep largestStableStep(const Chain& chain, const State& start, const Plan& plan,
                             const std::function<bool()>& stop) {
  Trials trials(chain, start, plan, stop);
  return stableStep(trials, chain, plan);
}

StabilityReport checkStability(const Chain& chain, const State& start, const Plan& plan,
                               const std::function<bool()>& stop) {
  Trials trials(chain, start, plan, stop);
  const Method& method = plan.method;
  const bool fixed = method.hasFixedStep();
  StabilityReport report;
  const auto trial = trials.run(trials.plan(), ReferenceUse::kAuto);
  report.tried = trial.has_value();
  if (trial) {
    report.verdict = trial->verdict;
    report.position_error = trial->position_error;
    report.text = fmt::format("{} with a {} over {:.4g} s: {}\n{}\n", method.name,
                              fmt::format(fixed ? "step size of {} s" : "tolerance of {} m",
                                          numberText(fixed ? plan.time_step : plan.tolerance)),
                              trials.duration(), trial->verdict.text, trial->measurements);
  } else {
    report.text = fmt::format("{}: takes too long to try\n", method.name);
  }
  if (!fixed) return report;
  report.stable = stableStep(trials, chain, plan);
  report.text += fmt::format("largest stable step size: {}\n", textOf(report.stable));
  if (!trial) return report;
  report.accurate_step = accurateStep(trials, chain, plan, *trial, report.stable.step);
  report.text += fmt::format("largest accurate step size: {}\n", stepText(report.accurate_step));
  return report;
}

std::string stabilityWarning(const Chain& chain, const State& start, const Plan& plan) {
  const Method& method = plan.method;
  if (!method.hasFixedStep() || plan.frames < 2) return {};
  checkPlan(plan);
  if (!isClearlyUnstable(method, chain, plan.time_step, durationOf(plan))) return {};
  return fmt::format("{} may be unstable with a time step of {} s; {}", method.name,
                     numberText(plan.time_step), remedyForDivergence(chain, start, plan));
}

std::string remedyForDivergence(const Chain& chain, const State& start, const Plan& plan,
                                const std::function<bool()>& stop) {
  Trials trials(chain, start, plan, stop);
  const Method& method = plan.method;
  std::string text = fmt::format("try a tolerance below {} m", numberText(plan.tolerance));
  if (method.hasFixedStep()) {
    const StableStep stable = stableStep(trials, chain, plan);
    // The equations of an implicit method may have no solution for this step, and one for larger steps.
    text = stable.step > plan.time_step
               ? fmt::format("try a step below {} s", numberText(plan.time_step))
               : fmt::format("largest stable step for {}: {}", method.name, textOf(stable));
  }
  if (method.name != "Auto") {
    Plan other = trials.plan();
    other.method = findMethod("Auto");
    other.frame_interval = std::clamp(plan.timeOfFrame(1), 1e-300, 1e6);
    other.tolerance = std::max(method.hasFixedStep() ? Plan{}.tolerance : plan.tolerance,
                               smallestTolerance(chain, trials.start()));
    const auto trial = trials.run(other, ReferenceUse::kNever, VerdictKind::kGainedEnergy);
    if (trial && trial->isStable()) text += "; or use Auto";
  }
  return stop && stop() ? "" : text;
}

}  // namespace spring_pendulum
