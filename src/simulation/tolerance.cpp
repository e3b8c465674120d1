#include "simulation/tolerance.hpp"

#include "base/numbers.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/smallest_tolerance.hpp>

#include <fmt/format.h>

namespace spring_pendulum {

void checkTolerance(double tolerance, const Chain& chain, const State& start) {
  const double least = smallestTolerance(chain, start);
  if (tolerance >= least) return;
  throw InputError(
      fmt::format("tolerance: must be at least {:.1e} m for this scene, because of the rounding "
                  "errors of its positions; got {}",
                  1.05 * least, numberText(tolerance)));
}

}  // namespace spring_pendulum
