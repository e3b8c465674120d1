#include "simulation/tolerance.hpp"

#include "base/numbers.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/smallest_tolerance.hpp>

#include <fmt/format.h>

namespace spring_pendulum {

void checkTolerance(const Scenario& scenario, const Chain& chain, const State& start) {
  if (scenario.method.get().hasFixedStep()) return;
  const double least = smallestTolerance(chain, start);
  if (scenario.tolerance >= least) return;
  throw InputError(
      fmt::format("tolerance: must be at least {:.1e} m for this scene, because of the rounding "
                  "errors of its positions; got {}",
                  1.05 * least, numberText(scenario.tolerance)));
}

}  // namespace spring_pendulum
