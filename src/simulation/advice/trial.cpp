#include "simulation/advice/trial.hpp"

#include "integration/work.hpp"
#include <spring_pendulum/integration/smallest_tolerance.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace spring_pendulum {
namespace {

constexpr double kMostFrames = 2000.0;
/// Longest trial in s, so that the end of its last frame is finite.
constexpr double kLongest = 1e300;

/// Nominal time of judging a frame, s. Measured: 0.25 us and 25 ns per particle.
double frameWork(Eigen::Index particles) {
  return 2.5e-8 * (static_cast<double>(particles) + 10.0);
}

}  // namespace

TrialBench::TrialBench(const Chain& chain, const State& start, double duration,
                       double frame_interval, std::function<bool()> stop, double most_work)
    : particles_{chain.masses(), start},
      spring_(chain.spring()),
      gravity_(chain.gravity()),
      air_drag_(chain.airDrag()),
      least_tolerance_(smallestTolerance(chain, start)),
      duration_(std::min(duration, kLongest)),
      frame_interval_(std::clamp(frame_interval, duration_ / kMostFrames, duration_)),
      stop_(std::move(stop)),
      most_work_(most_work),
      allowed_work_(kMostTotalWork * most_work) {}

Trial TrialBench::run(Scenario scenario, ReferenceUse reference, VerdictKind enough) const {
  if (isExhausted()) return {};
  scenario.stiffness = spring_.stiffness;
  scenario.damping = spring_.damping;
  scenario.rest_length = spring_.rest_length;
  scenario.gravity = gravity_;
  scenario.air_drag = air_drag_;
  scenario.reference = reference;
  scenario.on_divergence = OnDivergence::kStop;
  scenario.threads = 1;
  scenario.sleep = 0.0;
  const Integrator* counted = nullptr;
  std::int64_t frames = 0;
  const double frame_work = frameWork(particles_.state.size());
  const auto work = [&] { return counted->work() + static_cast<double>(frames) * frame_work; };
  // The negated comparison also ends a method whose work is not a number.
  const auto stop = [&] { return !(work() < most_work_) || (stop_ && stop_()); };
  Run run(scenario, particles_, {true, 0.0, stop});
  const auto integrator = run.makeIntegrator();
  counted = integrator.get();
  while (run.advance(*integrator) && run.verdict().kind < enough) ++frames;
  Trial trial;
  trial.finished = !run.wasStopped();
  trial.verdict = run.verdict();
  trial.position_error = run.positionError();
  trial.measured = run.referenceState() != nullptr;
  trial.measurements = run.measurements();
  trial.evaluations = integrator->forceEvaluations();
  trial.work = work();
  total_work_ += trial.work + run.referenceWork();
  return trial;
}

Trial TrialBench::run(const Method& method, double setting, ReferenceUse reference,
                      VerdictKind enough) const {
  Scenario scenario;
  scenario.method = method;
  if (method.hasFixedStep()) {
    scenario.time_step = setting;
    scenario.steps_per_frame = std::max<std::int64_t>(1, std::llround(frame_interval_ / setting));
  } else {
    scenario.tolerance = setting;
    scenario.frame_interval = std::clamp(frame_interval_, 1e-300, 1e6);  // as the option
  }
  const double frames = std::ceil(duration_ / frameSteps(scenario).timeOfFrame(1) * (1.0 - 1e-9));
  scenario.frames = static_cast<std::int64_t>(std::min(frames, 1e9)) + 1;
  return run(scenario, reference, enough);
}

double TrialBench::leastStep(const Method& method) const {
  const Eigen::Index particles = particles_.state.size();
  const double left = most_work_ - duration_ / frame_interval_ * frameWork(particles);
  if (left <= 0.0) return std::numeric_limits<double>::infinity();
  return std::max(duration_ * std::max(method.stages, 1) * kFixedStepTime.of(particles) / left,
                  std::numeric_limits<double>::denorm_min());
}

}  // namespace spring_pendulum
