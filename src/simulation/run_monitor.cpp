#include "simulation/run_monitor.hpp"

#include "base/numbers.hpp"
#include "model/chain_modes.hpp"
#include "simulation/integrator_settings.hpp"
#include "simulation/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

/// Particles times stages times steps whose energy balance takes about 50 ms.
constexpr double kCheapWork = 1e7;
/// Number of particles above which the kernels of explicit Runge-Kutta methods track the dissipated
/// energy at a cost of less than 10 %.
constexpr Eigen::Index kLongChain = 100;
/// Like kCheapWork for error-controlled methods: particles times steps.
constexpr double kCheapSteps = 8e5;
/// Position error that error-controlled methods promise, in tolerances.
constexpr double kPromise = 10.0;
/// Growth of perturbations above which a motion is too sensitive for this promise.
constexpr double kSensitiveGrowth = 100.0;

double toleranceOf(const Scenario& scenario) {
  return scenario.method.get().hasFixedStep() ? std::numeric_limits<double>::infinity()
                                              : scenario.tolerance;
}

JudgeOptions judgeOptions(const Scenario& scenario, bool tracks_dissipation) {
  return {tracks_dissipation, scenario.method.get().symplectic ? scenario.time_step : 0.0,
          scenario.method.get().hasFixedStep() ? 0.0 : scenario.tolerance};
}

/// Expected number of steps of an error-controlled method: about twenty per second, and more if
/// springs vibrate or stability limits the step size.
double expectedSteps(const Scenario& scenario, const Chain& chain) {
  const double mode = largestSpringMode(chain);  // 1/kg
  const double per_second =
      20.0 + 0.5 * std::sqrt(chain.spring().stiffness * mode) + 0.1 * chain.spring().damping * mode;
  return per_second * static_cast<double>(scenario.frames - 1) * scenario.frame_interval;
}

}  // namespace

bool energyBalanceIsCheap(const Scenario& scenario, const Chain& chain) {
  const auto particles = static_cast<double>(chain.size());
  if (!scenario.method.get().hasFixedStep())
    return expectedSteps(scenario, chain) * particles <= kCheapSteps;
  const Method& method = scenario.method;
  if (method.tableau != nullptr && chain.size() >= kLongChain) return true;
  const double steps =
      static_cast<double>(scenario.frames - 1) * static_cast<double>(scenario.steps_per_frame);
  return steps * method.stages * particles <= kCheapWork;
}

RunMonitor::RunMonitor(const Scenario& scenario, const Chain& chain, const State& start,
                       bool wants_energy)
    : scenario_(scenario),
      tracks_dissipation_(scenario.damping > 0.0 &&
                          (wants_energy || energyBalanceIsCheap(scenario, chain))),
      tolerance_(toleranceOf(scenario)),
      judge_(chain, start, judgeOptions(scenario, tracks_dissipation_)),
      work_per_evaluation_(workPerEvaluation(scenario.method, chain.size())) {
  checkMemory(scenario, chain.size());
  if (scenario.reference == ReferenceUse::kNever) return;
  const bool always = scenario.reference == ReferenceUse::kAlways;
  reference_.emplace(chain, start, ReferenceOptions{tolerance_, always});
}

void RunMonitor::restart() {
  judge_.restart();
  if (reference_) reference_->restart();
  evaluations_before_.reset();
  run_work_ = worst_residual_ = exceeded_time_ = exceeded_growth_ = 0.0;
}

void RunMonitor::follow(double time_step, std::int64_t steps) {
  if (!reference_ || !reference_->isMeasuring()) return;
  const auto start = std::chrono::steady_clock::now();
  reference_->advance(time_step, steps, run_work_);
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

const Verdict& RunMonitor::judge(double time, const State& state, const Integrator& integrator) {
  const std::int64_t evaluations = integrator.forceEvaluations();
  if (!evaluations_before_) evaluations_before_ = evaluations;
  run_work_ = work_per_evaluation_ * static_cast<double>(evaluations - *evaluations_before_);
  if (reference_) reference_->measureGrowth();
  judge_.judge(time, state, integrator.dissipatedEnergy(), reference_ ? &*reference_ : nullptr);
  worst_residual_ =
      std::max(worst_residual_, std::abs(judge_.entry().relative_residual.value_or(0.0)));
  noteTolerance();
  return judge_.latest();
}

void RunMonitor::noteTolerance() {
  const PositionError& error = judge_.positionError();
  if (exceeded_time_ > 0.0 ||
      !(error.now > std::max(kPromise * tolerance_, 2.0 * error.uncertainty)))
    return;
  exceeded_time_ = judge_.entry().time;
  exceeded_growth_ = reference_->growth();
}

bool RunMonitor::isShown() const {
  if (judge_.latest().kind != VerdictKind::kDiverged) return true;
  return scenario_.on_divergence == OnDivergence::kContinue &&
         std::isfinite(judge_.entry().energy.total());
}

EnergyEntry RunMonitor::energyEntry(double time, const State& state,
                                    const Integrator& integrator) const {
  return judge_.balance().entry(time, state, integrator.dissipatedEnergy());
}

double RunMonitor::positionErrorOf(const State& state) const {
  return reference_ ? reference_->errorOf(state) : std::numeric_limits<double>::quiet_NaN();
}

const ReferenceRun* RunMonitor::reference() const {
  return reference_ && reference_->isMeasuring() ? &*reference_ : nullptr;
}

std::string RunMonitor::measurements() const {
  const PositionError& error = judge_.positionError();
  std::string text = "position error not measured";
  if (error.measured_until > 0.0 || error.measured_until == judge_.entry().time) {
    text =
        error.largest > error.uncertainty
            ? fmt::format("largest position error {} m at t = {:.6g} s",
                          roundedText(error.largest, 2), error.largest_time)
            : fmt::format("largest position error below {} m", roundedText(error.uncertainty, 1));
    if (error.measured_until < judge_.entry().time) {
      text += fmt::format(" (measured until t = {:.6g} s)", error.measured_until);
    }
  }
  text += judge_.entry().relative_residual
              ? fmt::format(", largest energy error {} times the energy scale",
                            roundedText(worst_residual_, 2))
              : ", energy balance not checked";
  return text;
}

std::string RunMonitor::toleranceRemark() const {
  if (exceeded_time_ == 0.0) return {};
  if (exceeded_growth_ < kSensitiveGrowth) {
    return fmt::format("the position error exceeds ten times the tolerance from t = {:.6g} s on",
                       exceeded_time_);
  }
  return fmt::format(
      "sensitive from t = {:.6g} s on: by then small changes have grown by a factor of {}, "
      "so no method can promise a tolerance of {:.3g} m",
      exceeded_time_, roundedText(exceeded_growth_, 2), tolerance_);
}

}  // namespace spring_pendulum
