#include "base/checks.hpp"
#include "base/numbers.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include "simulation/advice/linear_stability.hpp"
#include "simulation/expected_memory.hpp"
#include "simulation/judge.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/simulation/outcome.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace spring_pendulum {
namespace {

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

/// Rounds down to three digits, exactly as printed; `largestSpringMode` is 1e-4 too large at most.
double roundedDown(double step) {
  const double unit = std::pow(10.0, std::floor(std::log10(step)) - 2.0);
  if (!std::isnormal(unit)) return step;
  return *parseNumber(fmt::format("{:.2e}", std::floor(step / unit * (1.0 + 1e-4)) * unit));
}

/// Simulated time of a run, s.
double durationOf(const Plan& plan) {
  return std::clamp(plan.timeOfFrame(plan.frames - 1), plan.step(), 1e300);
}

struct Trial {
  Verdict verdict;
  double position_error;  ///< the largest, m
  std::string measurements;
};

class Trials {
 public:
  Trials(const Chain& chain, const State& start, const Plan& plan, std::function<bool()> stop)
      : plan_(plan), scene_{chain.masses(), start, 0, chain.constants()}, stop_(std::move(stop)) {
    requireSize(chain.size(), start.size());
    if (chain.isDriven()) throw InputError("there is no advice for a driven chain");
    checkPlan(plan);
    const Method& method = plan.method;
    const bool has_kernel = method.tableau != nullptr && chain.isPlain() &&
                            findAdvanceKernel(fastestChainKernels(), *method.tableau) != nullptr;
    evaluation_time_ = method.hasFixedStep() && !has_kernel ? kPlainTime : 0.0;
    Plan own = plan;
    own.reference = ReferenceUse::kNever;
    checks_energy_ = Run(scene_, own).energyEntry().dissipated.has_value();
  }

  /// Runs a variant of the plan until the verdict is `enough` or worse; measures positions if they matter.
  /// \returns nothing if the allowed work was used up or the trial was stopped
  std::optional<Trial> run(Plan plan, VerdictKind enough) {
    if (total_work_ >= kMostTrials * kTrialWork || (stop_ && stop_())) return {};
    plan.on_divergence = OnDivergence::kStop;
    plan.threads = 1;
    if (plan.reference == ReferenceUse::kNever) plan.reference = ReferenceUse::kAuto;
    if (!measures(enough)) plan.reference = ReferenceUse::kNever;
    std::optional<Run> run;
    const auto work = [&] {
      const Integrator& integrator = run->integrator();
      return integrator.work() +
             evaluation_time_ * static_cast<double>(integrator.forceEvaluations()) +
             static_cast<double>(run->frame() * (scene_.state.size() + 10)) * kFrameTime;
    };
    // The negated comparison also ends a method whose work is not a number.
    const auto ends = [&] { return !(work() < kTrialWork) || (stop_ && stop_()); };
    run.emplace(scene_, plan, RunOptions{checks_energy_, 0.0, ends});
    while (run->advance() && run->verdict().kind < enough) continue;
    total_work_ += work() + run->referenceWork();
    if (run->wasStopped()) return {};
    std::string text = run->measurements();
    if (const std::string remark = run->toleranceRemark(); !remark.empty()) text += '\n' + remark;
    return Trial{run->verdict(), run->positionError().largest, std::move(text)};
  }

  /// The verdict on a run with another step size, with frames at about the same times.
  std::optional<Verdict> verdictWithStep(double step, VerdictKind enough) {
    const double duration = durationOf(plan_);
    if (duration / step > 1e9) return {};  // would take too long
    const double frame_work = kFrameTime * static_cast<double>(scene_.state.size() + 10);  // s
    const double frames = std::clamp(0.25 * kTrialWork / frame_work, 2000.0, 20000.0);
    const double interval = std::clamp(plan_.timeOfFrame(1), duration / frames, duration);
    Plan plan = plan_;
    plan.sleep = 0.0;
    plan.time_step = step;
    plan.steps_per_frame = std::max<std::int64_t>(1, std::llround(interval / step));
    plan.frames = std::max<std::int64_t>(1, std::llround(duration / plan.timeOfFrame(1))) + 1;
    const auto trial = run(plan, enough);
    return trial ? std::optional(trial->verdict) : std::nullopt;
  }

  /// Searches from `first` up to `most` for the largest step, within 2 %, with a better verdict than `bad`.
  /// \param failed a step size known to be bad
  /// \returns three digits; infinity for `most`, 0 if no run can be tried, NaN if no reference run can
  double largestStep(double first, double most, VerdictKind bad, double failed = kInfinity) {
    double found = 0.0, low = 0.0;  // verdicts are better; or at `low`, a run takes too long
    const double top = roundedDown(most);
    double step = roundedDown(std::min({first, most, failed / kPrecision}));
    for (double ratio = kPrecision; low < step && step < failed;
         ratio = std::min(ratio * ratio, 2.0)) {
      const auto tried = verdictWithStep(step >= top ? most : step, bad);
      if (!tried && std::isinf(failed)) break;
      const VerdictKind kind = tried.value_or(Verdict{}).kind;
      if (kind == VerdictKind::kNotChecked && measures(bad)) return std::nan("");
      (kind < bad ? low : failed) = step;
      if (tried && kind < bad) {
        found = step;
        until_ = kind == VerdictKind::kSensitive
                     ? fmt::format(" until t = {:.4g} s, when the motion is sensitive", tried->time)
                     : "";
      }
      if (found >= top || failed <= kPrecision * low) {
        // Nearly undamped chains have narrow intervals of unstable step sizes.
        if (verdictWithStep(0.9 * low, bad).value_or(Verdict{}).kind < bad) break;
        failed = 0.9 * low;
        found = low = 0.0;
      }
      step = roundedDown(low == 0.0           ? failed / ratio
                         : std::isinf(failed) ? std::min(ratio * low, most)
                                              : std::sqrt(low * failed));
    }
    if (found >= top) return kInfinity;
    return found;
  }

  const std::string& until() const { return until_; }  ///< when the found motion becomes sensitive

 private:
  /// Whether trials that end at a verdict need the position error.
  static bool measures(VerdictKind enough) { return enough != VerdictKind::kGainedEnergy; }

  Plan plan_;
  Scene scene_;
  std::function<bool()> stop_;
  double evaluation_time_;   ///< in addition to what the integrator counts, s
  double total_work_ = 0.0;  ///< s
  bool checks_energy_;       ///< as the run does, whatever the step
  std::string until_;
};

StableStep stableStep(Trials& trials, const Chain& chain, const Plan& plan) {
  const Method& method = plan.method;
  if (!method.hasFixedStep()) return {};
  const double duration = durationOf(plan);
  // Without damping, some methods gain energy with every step size: only trials tell how much.
  const bool has_limit = method.imaginary_stability_limit > 0.0 || chain.isDissipative();
  constexpr auto kBad = VerdictKind::kGainedEnergy;
  const double first = has_limit ? springStepLimit(method, chain, duration) : duration;
  StableStep stable{trials.largestStep(first, duration, kBad), false};
  if (stable.step == 0.0) stable = {roundedDown(linearStepLimit(method, chain, duration)), true};
  if (stable.step < plan.time_step) return stable;
  // In equilibrium, only many steps show that errors grow.
  const auto trial = trials.run(plan, kBad);
  if (!trial || trial->verdict.kind < kBad) return stable;
  return {trials.largestStep(first, duration, kBad, plan.time_step), false};
}

std::string stepText(double step, const std::string& remark) {
  if (std::isnan(step)) return "unknown, as a reference run would take too long";
  if (step == 0.0) return "unknown, as runs take too long to be tried";
  return (std::isinf(step) ? "the whole run" : fmt::format("{:.3g} s", step)) + remark;
}

std::string stepText(const StableStep& stable) {
  return stepText(stable.step, stable.is_estimate ? " (linear estimate)" : "");
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
  report.text = fmt::format("{}: takes too long to try\n", method.name);
  if (const auto trial = trials.run(plan, VerdictKind::kDiverged)) {
    report.verdict = trial->verdict;
    report.position_error = trial->position_error;
    report.text =
        fmt::format("{} with a {} of {} {} over {:.4g} s: {}\n{}\n", method.name,
                    fixed ? "step size" : "tolerance",
                    numberText(fixed ? plan.time_step : plan.tolerance), fixed ? "s" : "m",
                    plan.timeOfFrame(plan.frames - 1), trial->verdict.text, trial->measurements);
  }
  if (!fixed) return report;
  report.stable = stableStep(trials, chain, plan);
  report.text += fmt::format("largest stable step size: {}\n", stepText(report.stable));
  if (!report.verdict) return report;
  // The error grows with a power of the step size: the order of the method.
  const double allowed = Judge::kInaccurateThreshold * chainLength(chain, start);
  const double factor = std::pow(allowed / report.position_error, 1.0 / std::max(method.order, 1));
  double failed = kInfinity;
  if (plan.sleep == 0.0 && isBad(report.verdict->kind)) failed = plan.time_step;
  report.accurate_step = trials.largestStep(plan.time_step * (std::isnan(factor) ? 1.0 : factor),
                                            std::min(report.stable.step, durationOf(plan)),
                                            VerdictKind::kInaccurate, failed);
  if (std::isinf(report.accurate_step)) report.accurate_step = report.stable.step;
  report.text += fmt::format("largest accurate step size: {}\n",
                             stepText(report.accurate_step, trials.until()));
  return report;
}

std::string stabilityWarning(const Chain& chain, const State& start, const Plan& plan) {
  const Method& method = plan.method;
  if (!method.hasFixedStep() || plan.frames < 2 || chain.isDriven()) return {};
  checkPlan(plan);
  if (!isClearlyUnstable(method, chain, plan.time_step, durationOf(plan))) return {};
  return fmt::format("{} may be unstable with a time step of {} s; {}", method.name,
                     numberText(plan.time_step), remedyForDivergence(chain, start, plan));
}

std::string remedyForDivergence(const Chain& chain, const State& start, const Plan& plan,
                                const std::function<bool()>& stop) {
  Trials trials(chain, start, plan, stop);
  const Method& method = plan.method;
  const StableStep stable = stableStep(trials, chain, plan);
  std::string text = fmt::format("largest stable step for {}: {}", method.name, stepText(stable));
  // The equations of an implicit method may have no solution for this step, and one for larger steps.
  if (!method.hasFixedStep())
    text = fmt::format("try a tolerance below {} m", numberText(plan.tolerance));
  else if (stable.step >= plan.time_step)
    text = fmt::format("try a step below {} s", numberText(plan.time_step));
  if (method.name != "Auto") {
    Plan other = plan;
    other.method = findMethod("Auto");
    other.frame_interval = std::clamp(plan.timeOfFrame(1), 1e-300, 1e6);
    other.tolerance = std::max(method.hasFixedStep() ? Plan{}.tolerance : plan.tolerance,
                               smallestTolerance(chain, start));
    const auto trial = trials.run(other, VerdictKind::kGainedEnergy);
    if (trial && trial->verdict.kind < VerdictKind::kGainedEnergy) text += "; or use Auto";
  }
  return stop && stop() ? "" : text;
}

Remarks remarksOn(const Run& run) {
  Remarks remarks;
  if (std::string memory = memoryRemark(run.plan(), run.chain().size()); !memory.empty())
    remarks.notes.push_back(std::move(memory));
  if (const double gravity = run.chain().gravity(); gravity < 0.0)
    remarks.notes.push_back(
        fmt::format("gravity of {} m/s² points up: the chain falls upwards", numberText(gravity)));
  remarks.warning = stabilityWarning(run.chain(), run.start(), run.plan().from(run.firstFrame()));
  return remarks;
}

Outcome outcomeOf(const Run& run, const std::function<bool()>& stop) {
  const Verdict& verdict = run.verdict();
  if (verdict.kind == VerdictKind::kDiverged) {
    std::string remedy = "hands, forces, changes or a loaded state have driven the run";
    if (!run.isChanged() && !run.chain().isDriven())
      remedy =
          remedyForDivergence(run.chain(), run.start(), run.plan().from(run.firstFrame()), stop);
    return {3, {verdict.text + (remedy.empty() ? "" : "; " + remedy)}};
  }
  Outcome outcome;
  if (isBad(verdict.kind) || verdict.kind == VerdictKind::kSensitive)
    outcome.lines.push_back(verdict.text);
  if (std::string remark = run.toleranceRemark(); !remark.empty())
    outcome.lines.push_back(std::move(remark));
  return outcome;
}

}  // namespace spring_pendulum
