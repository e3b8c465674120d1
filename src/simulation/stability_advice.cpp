#include "model/chain_modes.hpp"
#include "simulation/mode_response.hpp"
#include <spring_pendulum/model/energy.hpp>
#include <spring_pendulum/simulation/energy_balance.hpp>
#include <spring_pendulum/simulation/frame_steps.hpp>
#include <spring_pendulum/simulation/stability_advice.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr double kScanStart = 1e-5;  ///< s = h |λ|; below, rounding hides what grows
constexpr double kSmallStep = 0.1;
constexpr double kScanEnd = 1e5;          ///< a method that bears this bears everything
constexpr double kScanRatio = 1.02;       ///< narrower than any gap in a stability region
constexpr double kSlowestMode = 1e-4;     ///< of the fastest one; slower ones decide nothing
constexpr double kTensionInMotion = 3.0;  ///< over that at rest
// Share of the gain the verdict allows that the linear estimate may use up. Measured against
// bisection: without it the advice is up to 9 times (Euler) and 1.06 times too large.
constexpr double kFirstOrderShare = 0.07;
constexpr double kHigherOrderShare = 0.8;
constexpr double kLeastSwing = 8.0 * 3.14159265358979;  ///< rad; what is gained is gained early
constexpr double kMostSwingGrowth = 0.05;  ///< also of a swing so small that it may grow more

/// The largest s up to which a growing property of a method stays allowed.
template <typename IsAllowed>
double firstCrossing(double most, const IsAllowed& is_allowed) {
  double s = kScanStart;
  while (s < most && is_allowed(s)) s *= kScanRatio;
  if (s >= most) return most;
  double least = s / kScanRatio;
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (least + s);
    (is_allowed(middle) ? least : s) = middle;
  }
  return least;
}

/// The same for growth rates that are too large already where the scan starts: they follow a power
/// law there.
double crossingOfPowerLaw(const ModeResponse& response, double allowed_rate) {
  const double rate = response.growthRate(kScanStart);
  const double power = std::log2(response.growthRate(2.0 * kScanStart) / rate);
  return kScanStart * std::pow(allowed_rate / rate, 1.0 / power);
}

/// Largest s at which a mode grows by at most `allowed_rate` per 1/|λ|.
double largestStepFor(const ModeResponse& response, double allowed_rate, double most) {
  if (response.growthRate(kScanStart) > allowed_rate) {
    return std::min(most, crossingOfPowerLaw(response, allowed_rate));
  }
  return firstCrossing(most, [&](double s) { return response.growthRate(s) <= allowed_rate; });
}

class Advisor {
 public:
  Advisor(const Method& method, const Chain& chain, const State& start, double duration)
      : method_(method),
        chain_(chain),
        start_(start),
        duration_(duration),
        mode_(largestSpringMode(chain)) {
    const Energy energy = computeEnergy(chain, start);
    const double scale = EnergyScale(chain, start).at(0.0);
    if (scale == 0.0) return;
    free_share_ = (energy.total() + scale - std::max(energy.total(), 0.0)) / scale;
    loaded_share_ = std::min(energy.spring / scale, free_share_) /
                    static_cast<double>(std::max<Eigen::Index>(chain.size() - 1, 1));
  }

  StabilityAdvice advise(double time_step) const {
    StabilityAdvice advice{kNoLimit, kNoLimit, 1.0};
    if (method_.control != StepControl::kFixed || mode_ == 0.0) return advice;
    if (!std::isfinite(fasterRoot(chain_.spring(), mode_))) return {0.0, 0.0, kNoLimit};
    advice.spring_step = springStep();
    advice.swing_step = swingStep();
    advice.swing_growth = swingGrowth(time_step);
    return advice;
  }

 private:
  double springStep() const {
    double step = kNoLimit;
    const double slowest = chain_.size() == 2 ? 1.0 : kSlowestMode;
    for (double part = 1.0; part >= slowest; part *= 0.5) {
      step = std::min(step, stepForMode(chain_.spring(), mode_ * part, step));
    }
    if (growsUndampedModes()) return step;  // at any step: swingStep() says how much
    const double swing = fastestSwing(chain_);
    const double square =
        std::min(kTensionInMotion * swing * swing, chain_.spring().stiffness * mode_);
    return std::min(step, stepForMode({square, 0.0, 1.0}, 1.0, step));
  }

  bool growsUndampedModes() const {
    return ModeResponse(method_, 0.0).growthRate(kSmallStep) > 0.0;
  }

  double stepForMode(const SpringLaw& spring, double mode, double known_step) const {
    const double root = fasterRoot(spring, mode);
    if (root == 0.0) return kNoLimit;
    const ModeResponse response(method_, dampingRatio(spring, mode));
    const double allowed_rate = std::log(1.0 + Judge::kGainThreshold) / (duration_ * root);
    const double most = std::min(kScanEnd, known_step * root);
    double s = largestStepFor(response, allowed_rate, most);
    if (s < most && spring.damping > 0.0 && loaded_share_ > 0.0) {
      const double allowed_gain = 1.0 + Judge::kGainThreshold / loaded_share_;
      s = firstCrossing(s, [&](double x) { return response.largestGain(x) <= allowed_gain; });
    }
    return s < kScanEnd ? s / root : kNoLimit;
  }

  /// Growth of the swinging relative to that of an undamped spring of the fastest mode.
  double swingShare() const {
    const double swing = slowSwing(chain_);
    return swing * swing / (chain_.spring().stiffness * mode_);
  }

  double swingStep() const {
    const double share = swingShare();
    if (!(share > 0.0)) return kNoLimit;
    const double frequency = std::sqrt(chain_.spring().stiffness * mode_);
    const double part = method_.order == 1 ? kFirstOrderShare : kHigherOrderShare;
    const double allowed_growth =
        std::min(std::log(1.0 + part * Judge::kGainThreshold / free_share_), kMostSwingGrowth);
    const double duration = std::max(duration_, kLeastSwing / slowSwing(chain_));
    const double allowed_rate = allowed_growth / (share * frequency * duration);
    const double s = largestStepFor(ModeResponse(method_, 0.0), allowed_rate, kScanEnd);
    return s < kScanEnd ? s / frequency : kNoLimit;
  }

  double swingGrowth(double time_step) const {
    const double share = swingShare();
    if (!(share > 0.0)) return 1.0;
    const double frequency = std::sqrt(chain_.spring().stiffness * mode_);
    const double rate = ModeResponse(method_, 0.0).growthRate(time_step * frequency);
    return std::exp(share * rate * frequency * duration_);
  }

  const Method& method_;
  const Chain& chain_;
  const State& start_;
  double duration_;
  double mode_;
  double free_share_ = 0.0;    ///< energy above that of the hanging rest, parts of the scale
  double loaded_share_ = 0.0;  ///< part of it that starts in the springs, for each of their modes
};

double durationOf(const Scenario& scenario) {
  const FrameSteps step = frameSteps(scenario);
  return std::max(step.timeOfFrame(scenario.frames - 1), step.time_step);
}

StabilityAdvice adviseOn(const Method& method, const Chain& chain, const State& start,
                         const Scenario& scenario) {
  return adviseOnStability(method, chain, start, scenario.time_step, durationOf(scenario));
}

std::string stepText(double step) {
  return std::isinf(step) ? "any step" : fmt::format("steps up to {:.3g} s", step);
}

std::string suggestion(const Chain& chain, const State& start, const Scenario& scenario) {
  const std::string method = methodThatHolds(chain, start, scenario);
  if (method.empty()) return "";
  if (findMethod(method).control == StepControl::kErrorControlled) {
    return fmt::format("; {} holds, which chooses its own steps", method);
  }
  return fmt::format("; {} holds with {} s", method, scenario.time_step);
}

/// What is wrong with the scenario's step, empty if nothing is.
std::string objection(const StabilityAdvice& advice, const Scenario& scenario) {
  const double step = scenario.time_step;
  if (step > advice.spring_step) {
    return fmt::format("a step of {} s is too large for the springs: {} bears {} here", step,
                       scenario.method, stepText(advice.largestStep()));
  }
  if (step > advice.swing_step) {
    return fmt::format(
        "{} lets the swinging gain energy at every step size: the slow swing up to {:.3g} % in "
        "this run at {} s, for sure under {:.2g} % only with {}",
        scenario.method, 100.0 * (advice.swing_growth - 1.0), step, 100.0 * Judge::kGainThreshold,
        stepText(advice.swing_step));
  }
  return "";
}

}  // namespace

StabilityAdvice adviseOnStability(const Method& method, const Chain& chain, const State& start,
                                  double time_step, double duration) {
  return Advisor(method, chain, start, duration).advise(time_step);
}

std::string methodThatHolds(const Chain& chain, const State& start, const Scenario& scenario) {
  const Method& given = findMethod(scenario.method);
  const Method* best = nullptr;
  const Method* error_controlled = nullptr;
  for (const Method& method : methodTable()) {
    if (method.control == StepControl::kErrorControlled) {
      if (error_controlled == nullptr || method.name == "Auto") error_controlled = &method;
      continue;
    }
    if (method.order < given.order || (best != nullptr && method.stages >= best->stages)) continue;
    if (scenario.time_step <= adviseOn(method, chain, start, scenario).largestStep()) {
      best = &method;
    }
  }
  if (best == nullptr || given.control == StepControl::kErrorControlled) best = error_controlled;
  return best == nullptr || best == &given ? "" : std::string(best->name);
}

std::string describeStability(const Chain& chain, const State& start, const Scenario& scenario) {
  const Method& method = findMethod(scenario.method);
  std::string text = fmt::format(
      "fastest spring mode {:.3g} 1/s, fastest swing {:.3g} rad/s, slow swing {:.3g} rad/s\n",
      fasterRoot(chain.spring(), largestSpringMode(chain)), fastestSwing(chain), slowSwing(chain));
  if (method.control == StepControl::kErrorControlled) {
    return text + fmt::format("{} chooses its own steps\n", method.name);
  }
  const StabilityAdvice advice = adviseOn(method, chain, start, scenario);
  text += fmt::format("{}: the springs bear {}", method.name, stepText(advice.spring_step));
  if (advice.swing_step < advice.spring_step) {
    text += fmt::format(", the swinging surely {}", stepText(advice.swing_step));
  }
  const std::string wrong = objection(advice, scenario);
  text += wrong.empty() ? fmt::format("; a step of {} s holds\n", scenario.time_step)
                        : fmt::format("\n{}{}\n", wrong, suggestion(chain, start, scenario));
  return text;
}

std::string warnOfInstability(const Chain& chain, const State& start, const Scenario& scenario) {
  const Method& method = findMethod(scenario.method);
  if (method.control == StepControl::kErrorControlled) return "";
  const std::string wrong = objection(adviseOn(method, chain, start, scenario), scenario);
  return wrong.empty() ? "" : wrong + suggestion(chain, start, scenario);
}

std::string remedyForDivergence(const Chain& chain, const State& start, const Scenario& scenario) {
  const Method& method = findMethod(scenario.method);
  if (method.control == StepControl::kErrorControlled) {
    return fmt::format("a tolerance below {} m may hold{}", scenario.tolerance,
                       suggestion(chain, start, scenario));
  }
  const StabilityAdvice advice = adviseOn(method, chain, start, scenario);
  const double step = std::min(advice.largestStep(), 0.5 * scenario.time_step);
  return fmt::format("{} bears {} here{}", method.name, stepText(step),
                     suggestion(chain, start, scenario));
}

}  // namespace spring_pendulum
