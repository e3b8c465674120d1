#include <spring_pendulum/integration/integrator.hpp>

#include <algorithm>
#include <cmath>

namespace spring_pendulum {

std::int64_t Integrator::advanceWithin(State& state, double time_step, std::int64_t steps,
                                       double most_work) {
  if (!std::isfinite(most_work)) {
    advance(state, time_step, steps);
    return steps;
  }
  std::int64_t completed = 0;
  for (double before = work(); completed < steps && before < most_work;) {
    const double affordable = step_work_ > 0.0 ? (most_work - before) / step_work_ : 1.0;
    const auto left = static_cast<double>(steps - completed);
    const auto count = affordable < left
                           ? std::max(static_cast<std::int64_t>(affordable), std::int64_t{1})
                           : steps - completed;
    advance(state, time_step, count);
    completed += count;
    const double after = work();
    step_work_ = (after - before) / static_cast<double>(count);
    before = after;
  }
  return completed;
}

}  // namespace spring_pendulum
