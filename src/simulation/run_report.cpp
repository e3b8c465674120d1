// What a run says about itself.
#include "base/numbers.hpp"
#include <spring_pendulum/simulation/run.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

/// Position error that error-controlled methods promise, in tolerances.
constexpr double kPromise = 10.0;
/// Growth of perturbations above which a motion is too sensitive for this promise.
constexpr double kSensitiveGrowth = 100.0;

}  // namespace

std::string Run::closingLine(const Integrator& integrator, const std::string& output) const {
  const Method& method = scenario_.method;
  const std::string report = integrator.report();
  return fmt::format(
      "{}{}: {}, {}{}, {}{}, {} integrating{}, {} reference run, {}, verdict: {}", method.name,
      report.empty() ? "" : " (" + report + ")", counted(chain_.size(), "particle"),
      counted(totals_.frames, "frame"),
      totals_.slept_frames > 0 ? fmt::format(" ({} at rest, not integrated)", totals_.slept_frames)
                               : "",
      method.hasFixedStep() ? counted(totals_.integrated_frames * frame_steps_.steps, "step") + ", "
                            : "",
      counted(integrator.forceEvaluations(), "force evaluation"), durationText(totals_.seconds),
      output, durationText(totals_.reference_seconds), measurements(), toString(verdict().kind));
}

void Run::noteTolerance() {
  if (scenario_.method.get().hasFixedStep() || exceeded_time_ > 0.0) return;
  const PositionError& error = judge_.positionError();
  if (!(error.now > std::max(kPromise * scenario_.tolerance, 2.0 * error.uncertainty))) return;
  exceeded_time_ = judge_.entry().time;
  exceeded_growth_ = reference_->growth();
}

std::string Run::measurements() const {
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

std::string Run::toleranceRemark() const {
  if (exceeded_time_ == 0.0) return {};
  if (exceeded_growth_ < kSensitiveGrowth) {
    return fmt::format("the position error exceeds ten times the tolerance from t = {:.6g} s on",
                       exceeded_time_);
  }
  return fmt::format(
      "sensitive from t = {:.6g} s on: by then small changes have grown by a factor of {}, "
      "so no method can promise a tolerance of {:.3g} m",
      exceeded_time_, roundedText(exceeded_growth_, 2), scenario_.tolerance);
}

}  // namespace spring_pendulum
