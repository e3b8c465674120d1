#include "simulation/advice/trial.hpp"

#include "integration/work.hpp"
#include <spring_pendulum/simulation/reference_run.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace spring_pendulum {

Trial TrialBench::run(const Method& method, std::optional<double> tolerance,
                      const FrameSteps& frame, std::int64_t frames, bool with_reference,
                      VerdictKind enough) const {
  IntegratorOptions integrator_options;
  integrator_options.tolerance = tolerance.value_or(integrator_options.tolerance);
  integrator_options.track_dissipation = true;
  integrator_options.threads = 1;
  const auto integrator = makeIntegrator(method, chain_, integrator_options);
  const bool fixed = method.hasFixedStep();
  Judge judge(
      chain_, start_,
      JudgeOptions{true, method.symplectic ? frame.time_step : 0.0, tolerance.value_or(0.0)});
  ReferenceOptions options;
  options.run_tolerance = tolerance.value_or(options.run_tolerance);
  ReferenceRun reference(chain_, start_, options);
  State state = start_;
  Trial trial;
  if (fixed) trial.affordable = frames <= affordableFrames(method, frame);
  for (std::int64_t n = 1; n <= frames && trial.affordable; ++n) {
    trial.affordable =
        integrator->advanceWithin(state, frame.time_step, frame.steps, most_work_) == frame.steps;
    trial.evaluations = integrator->forceEvaluations();
    trial.work = integrator->work();
    const double time = frame.timeOfFrame(n);
    if (with_reference) {
      reference.advance(frame.time_step, frame.steps, trial.work);
      judge.judge(time, state, integrator->dissipatedEnergy(), &reference);
    } else {
      judge.judge(time, state, integrator->dissipatedEnergy());
    }
    trial.energy_error =
        std::max(trial.energy_error, std::abs(judge.entry().relative_residual.value_or(0.0)));
    if (judge.latest().kind >= enough) break;
  }
  trial.position_error = judge.positionError();
  trial.measured = with_reference && reference.isMeasuring();
  trial.reference_too_costly = reference.status() == ReferenceRun::Status::kCostTooMuch;
  trial.verdict = judge.worst();
  return trial;
}

Trial TrialBench::run(const Method& method, double step, bool with_reference,
                      VerdictKind enough) const {
  if (!method.hasFixedStep()) {
    const double frames = std::ceil(duration_ / frame_interval_ * (1.0 - 1e-9));
    return run(method, step, {frame_interval_, 1}, static_cast<std::int64_t>(frames),
               with_reference, enough);
  }
  const FrameSteps frame{step, std::max<std::int64_t>(1, std::llround(frame_interval_ / step))};
  const double frames = std::ceil(duration_ / frame.timeOfFrame(1) * (1.0 - 1e-9));
  return run(method, std::nullopt, frame, static_cast<std::int64_t>(frames), with_reference,
             enough);
}

std::int64_t TrialBench::affordableFrames(const Method& method, const FrameSteps& frame) const {
  const double evaluations = static_cast<double>(frame.steps) * method.stages;
  return static_cast<std::int64_t>(most_work_ / nominalFixedStepTime(chain_.size()) / evaluations);
}

double TrialBench::workOf(const Method& method, double step) const {
  return duration_ / step * method.stages * nominalFixedStepTime(chain_.size());
}

double TrialBench::leastStep(const Method& method) const {
  return duration_ * method.stages * nominalFixedStepTime(chain_.size()) / most_work_;
}

}  // namespace spring_pendulum
