#include "base/checks.hpp"
#include "base/numbers.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include "simulation/advice/linear_stability.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/integration/smallest_tolerance.hpp>
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
/// Work in s allowed for a trial, without its reference run, and for that of `stabilityWarning`.
constexpr double kTrialWork = 0.1;
constexpr double kShortWork = 0.006;
/// Work allowed for all trials with their reference runs, in trials.
constexpr double kMostTrials = 30.0;
/// Nominal time in s of judging a frame, per particle, and of an evaluation in code without a fast
/// kernel, beyond what the integrator counts. Measured: 25 ns, and 320 to 470 ns for 6 particles.
constexpr double kFrameTime = 2.5e-8;
constexpr double kPlainTime = 4e-7;

constexpr const char* kTooLong = "unknown, as runs take too long to be tried";
constexpr const char* kNotJudged = "unknown, as a reference run would take too long";

/// Rounds down to three significant digits; `largestSpringMode` is 1e-4 too large at most.
double roundedDown(double step) {
  const double unit = std::pow(10.0, std::floor(std::log10(step)) - 2.0);
  return std::isnormal(unit) ? std::floor(step / unit * (1.0 + 1e-4)) * unit : step;
}

/// Simulated time of a run, s.
double durationOf(const Scenario& scenario) {
  const FrameSteps step = frameSteps(scenario);
  return std::clamp(step.timeOfFrame(scenario.frames - 1), step.time_step, 1e300);
}

struct Trial {
  bool finished = false;  ///< false: the allowed work was used up, or the trial was stopped
  bool judged = false;  ///< whether the true positions were known, or are too sensitive to be known
  Verdict verdict;
  PositionError position_error;
  std::string measurements;

  bool isStable() const { return finished && verdict.kind < VerdictKind::kGainedEnergy; }
};

/// Trial runs of a scene.
class Trials {
 public:
  Trials(const Chain& chain, const State& start, const Scenario& scenario,
         std::function<bool()> stop = {})
      : scenario_(scenario), particles_{chain.masses(), start}, stop_(std::move(stop)) {
    requireSize(chain.size(), start.size());
    checkScenario(scenario);
    scenario_.stiffness = chain.spring().stiffness;
    scenario_.damping = chain.spring().damping;
    scenario_.rest_length = chain.spring().rest_length;
    scenario_.gravity = chain.gravity();
    scenario_.air_drag = chain.airDrag();
    particles_.state = startOf(scenario_, chain, particles_);
    scenario_.start = Start::kFile;
    scenario_.on_divergence = OnDivergence::kStop;
    scenario_.threads = 1;
    scenario_.sleep = 0.0;
    interval_ = frameSteps(scenario_).timeOfFrame(1);
    duration_ = durationOf(scenario_);
    const Method& method = scenario_.method;
    const bool has_kernel = method.tableau != nullptr && chain.isPlain() &&
                            findAdvanceKernel(fastestChainKernels(), *method.tableau) != nullptr;
    evaluation_time_ = method.hasFixedStep() && !has_kernel ? kPlainTime : 0.0;
  }

  /// That of the constructor with the start and the constants of the trials.
  const Scenario& scenario() const { return scenario_; }
  double duration() const { return duration_; }
  const State& start() const { return particles_.state; }
  bool isExhausted() const { return total_work_ >= kMostTrials * kTrialWork || (stop_ && stop_()); }

  /// Runs a variant of `scenario()` until the verdict is `enough` or worse.
  Trial run(const Scenario& scenario, ReferenceUse reference,
            VerdictKind enough = VerdictKind::kDiverged, double most_work = kTrialWork) {
    if (isExhausted()) return {};
    Scenario tried = scenario;
    tried.reference = reference;
    const Integrator* counted = nullptr;
    double frames = 0.0;
    const auto work = [&] {
      return counted->work() + evaluation_time_ * static_cast<double>(counted->forceEvaluations()) +
             frames * kFrameTime * (static_cast<double>(particles_.state.size()) + 10.0);
    };
    // The negated comparison also ends a method whose work is not a number.
    Run run(tried, particles_,
            {false, 0.0, [&] { return !(work() < most_work) || (stop_ && stop_()); }});
    counted = &run.integrator();
    while (run.advance() && run.verdict().kind < enough) ++frames;
    total_work_ += work() + run.referenceWork();
    const bool is_known =
        run.referenceState() != nullptr || run.verdict().kind == VerdictKind::kSensitive;
    return {!run.wasStopped(), is_known, run.verdict(), run.positionError(), run.measurements()};
  }

  /// A run with another step size, with frames at about the same times.
  Trial runWithStep(double step, ReferenceUse reference, VerdictKind enough) {
    constexpr double kMostFrames = 2000.0;
    constexpr double kMostSteps = 1e9;
    if (duration_ / step > kMostSteps) return {};
    const double interval = std::clamp(interval_, duration_ / kMostFrames, duration_);
    Scenario scenario = scenario_;
    scenario.time_step = step;
    scenario.steps_per_frame = std::max<std::int64_t>(1, std::llround(interval / step));
    const double frames = std::round(duration_ / frameSteps(scenario).timeOfFrame(1));
    scenario.frames = static_cast<std::int64_t>(std::clamp(frames, 1.0, 1e9)) + 1;
    return run(scenario, reference, enough);
  }

 private:
  Scenario scenario_;
  Particles particles_;
  std::function<bool()> stop_;
  double interval_ = 0.0;         ///< between frames, s
  double duration_ = 0.0;         ///< s
  double evaluation_time_ = 0.0;  ///< in addition to what the integrator counts, s
  double total_work_ = 0.0;       ///< s
};

struct Found {
  double step;   ///< s; 0: none of those tried, infinite: all
  double tried;  ///< the smallest step size tried, s; infinite: none
};

/// Returns the largest step size up to `most` that passes, within 2 % and with three digits: `first` if it
/// passes and a slightly larger one does not. 0.95, 0.9, 0.8 and 0.65 times the result pass, too.
/// \param failed a step size known to fail, or infinite
/// \param passes nothing if the step size, and so each smaller one, takes too long to be tried
Found largestPassingStep(double first, double most, double failed,
                         const std::function<std::optional<bool>(double)>& passes) {
  Found found{0.0, failed};
  double low = 0.0;  // passes or takes too long
  double stride = kPrecision;
  double step = roundedDown(std::min({first, most, failed / kPrecision}));
  for (double ratio = kPrecision; step > low && step < failed; ratio *= ratio) {
    const std::optional<bool> passed = passes(step);
    if (!passed && std::isinf(failed)) return found;
    if (passed) found.tried = std::min(found.tried, step);
    if (passed == true) found.step = step;
    if (passed == true && step >= roundedDown(most)) return {kInfinity, found.tried};
    (passed == false ? failed : low) = step;
    if (failed <= kPrecision * low) {
      // Nearly undamped chains have narrow intervals of unstable step sizes; below each, the stride
      // grows.
      for (const double share : {0.95, 0.9, 0.8, 0.65}) {
        if (found.step == 0.0 || passes(share * low) != false) continue;
        failed = share * low;
        low = found.step = 0.0;
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

StableStep stableStep(Trials& trials, const Chain& chain, const Scenario& scenario) {
  const Method& method = scenario.method;
  if (!method.hasFixedStep()) return {};
  // Without damping, some methods gain energy with every step size: only trials tell how much.
  const bool has_limit = method.imaginary_stability_limit > 0.0 || chain.isDissipative();
  const Found found = largestPassingStep(
      has_limit ? springStepLimit(method, chain, trials.duration()) : trials.duration(),
      trials.duration(), kInfinity, [&](double step) -> std::optional<bool> {
        const Trial trial =
            trials.runWithStep(step, ReferenceUse::kNever, VerdictKind::kGainedEnergy);
        if (!trial.finished) return std::nullopt;
        return trial.isStable();
      });
  if (found.step > 0.0) return {found.step, false};
  const double limit = linearStepLimit(method, chain, trials.duration());
  return {std::isfinite(limit) ? roundedDown(limit) : limit, true};
}

/// Returns the largest step size without a bad verdict, up to the stable one.
/// \param trial of the scenario, whose error grows with a power of the step size: the order of the method
/// \returns NaN if a reference run would take too long
Found accurateStep(Trials& trials, const Chain& chain, const Scenario& scenario, const Trial& trial,
                   double stable) {
  const Method& method = scenario.method;
  const double allowed = Judge::kInaccurateThreshold * chainLength(chain, trials.start());
  const double error = trial.position_error.largest;
  const double factor = std::pow(allowed / error, 1.0 / std::max(method.order, 1));
  double failed = kInfinity;
  if (isBad(trial.verdict.kind)) failed = scenario.time_step;
  bool is_judged = true;
  Found found = largestPassingStep(
      std::isfinite(error) ? scenario.time_step * factor : scenario.time_step,
      std::min(stable, trials.duration()), failed, [&](double step) -> std::optional<bool> {
        const Trial tried = trials.runWithStep(step, ReferenceUse::kAuto, VerdictKind::kInaccurate);
        is_judged = is_judged && (tried.judged || !tried.isStable());
        if (!tried.finished || !is_judged) return std::nullopt;
        return !isBad(tried.verdict.kind);
      });
  if (std::isinf(found.step)) found.step = stable;
  if (!is_judged) found.step = kNan;
  return found;
}

std::string stepText(double step) {
  return std::isinf(step) ? "the whole run" : fmt::format("{:.3g} s", step);
}

std::string textOf(const StableStep& stable) {
  if (stable.step == 0.0) return kTooLong;
  return stepText(stable.step) + (stable.is_estimate ? " (linear estimate)" : "");
}

std::string textOf(const Found& accurate) {
  if (std::isnan(accurate.step)) return kNotJudged;
  if (accurate.step > 0.0) return stepText(accurate.step);
  if (std::isinf(accurate.tried)) return kTooLong;
  return fmt::format("below {}, where runs take too long to be tried", stepText(accurate.tried));
}

}  // namespace

StableStep largestStableStep(const Chain& chain, const State& start, const Scenario& scenario,
                             const std::function<bool()>& stop) {
  Trials trials(chain, start, scenario, stop);
  return stableStep(trials, chain, scenario);
}

StabilityReport checkStability(const Chain& chain, const State& start, const Scenario& scenario,
                               const std::function<bool()>& stop) {
  Trials trials(chain, start, scenario, stop);
  const Method& method = scenario.method;
  const bool fixed = method.hasFixedStep();
  StabilityReport report;
  const Trial trial = trials.run(trials.scenario(), ReferenceUse::kAuto);
  report.tried = trial.finished;
  if (trial.finished) {
    report.verdict = trial.verdict;
    report.position_error = trial.position_error;
    report.text =
        fmt::format("{} with a {} over {:.4g} s: {}\n{}\n", method.name,
                    fmt::format(fixed ? "step size of {} s" : "tolerance of {} m",
                                numberText(fixed ? scenario.time_step : scenario.tolerance)),
                    trials.duration(), trial.verdict.text, trial.measurements);
  } else {
    report.text = fmt::format("{}: takes too long to try\n", method.name);
  }
  if (!fixed) return report;
  report.stable = stableStep(trials, chain, scenario);
  report.text += fmt::format("largest stable step size: {}\n", textOf(report.stable));
  if (!trial.finished) return report;
  const Found accurate = accurateStep(trials, chain, scenario, trial, report.stable.step);
  report.accurate_step = accurate.step;
  report.text += fmt::format("largest accurate step size: {}\n", textOf(accurate));
  return report;
}

std::string stabilityWarning(const Chain& chain, const State& start, const Scenario& scenario,
                             bool tries_run) {
  const Method& method = scenario.method;
  if (!method.hasFixedStep() || scenario.frames < 2) return {};
  checkScenario(scenario);
  const bool clearly = isClearlyUnstable(method, chain, scenario.time_step, durationOf(scenario));
  std::string found;
  if (!clearly) {
    if (!tries_run) return {};
    Trials trials(chain, start, scenario);  // copies the state
    const Trial trial =
        trials.run(trials.scenario(), ReferenceUse::kNever, VerdictKind::kGainedEnergy, kShortWork);
    if (trial.verdict.kind < VerdictKind::kGainedEnergy) return {};
    found = fmt::format(" ({})", trial.verdict.text);
  }
  return fmt::format("{} {} unstable with a time step of {} s{}; {}", method.name,
                     clearly ? "may be" : "is", numberText(scenario.time_step), found,
                     remedyForDivergence(chain, start, scenario));
}

std::string remedyForDivergence(const Chain& chain, const State& start, const Scenario& scenario,
                                const std::function<bool()>& stop) {
  Trials trials(chain, start, scenario, stop);
  const Method& method = scenario.method;
  std::string text = fmt::format("try a tolerance below {} m", numberText(scenario.tolerance));
  if (method.hasFixedStep()) {
    const StableStep stable = stableStep(trials, chain, scenario);
    // The equations of an implicit method may have no solution for this step, and one for larger steps.
    text = stable.step > scenario.time_step
               ? fmt::format("try a step below {} s", numberText(scenario.time_step))
               : fmt::format("largest stable step for {}: {}", method.name, textOf(stable));
  }
  if (method.name != "Auto") {
    Scenario other = trials.scenario();
    other.method = findMethod("Auto");
    other.frame_interval = std::clamp(frameSteps(scenario).timeOfFrame(1), 1e-300, 1e6);
    other.tolerance = std::max(method.hasFixedStep() ? Scenario{}.tolerance : scenario.tolerance,
                               smallestTolerance(chain, trials.start()));
    if (trials.run(other, ReferenceUse::kNever, VerdictKind::kGainedEnergy).isStable())
      text += "; or use Auto";
  }
  return stop && stop() ? "" : text;
}

}  // namespace spring_pendulum
