#include <spring_pendulum/integration/integrator.hpp>

#include <algorithm>

namespace spring_pendulum {
namespace {

/// Work between two questions whether to stop, s.
constexpr double kWorkBetweenStops = 0.005;

}  // namespace

std::int64_t Integrator::advance(State& state, double time_step, std::int64_t steps,
                                 const std::function<bool()>& stop) {
  if (!stop || steps <= 0) {
    integrate(state, time_step, steps);
    return steps;
  }
  std::int64_t completed = 0;
  while (completed < steps && !stop())
    completed += integrateWithin(state, time_step, steps - completed, work() + kWorkBetweenStops);
  return completed;
}

std::int64_t Integrator::integrateWithin(State& state, double time_step, std::int64_t steps,
                                         double most_work) {
  std::int64_t completed = 0;
  for (double before = work(); completed < steps && before < most_work;) {
    const double affordable = step_work_ > 0.0 ? (most_work - before) / step_work_ : 1.0;
    const auto left = static_cast<double>(steps - completed);
    const auto count = affordable < left
                           ? std::max(static_cast<std::int64_t>(affordable), std::int64_t{1})
                           : steps - completed;
    integrate(state, time_step, count);
    completed += count;
    const double after = work();
    step_work_ = (after - before) / static_cast<double>(count);
    before = after;
  }
  return completed;
}

}  // namespace spring_pendulum
