#include "simulation/tolerance.hpp"

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace spring_pendulum {
namespace {

/// Units in the last place of the largest coordinate; an interpolated position has some of them.
constexpr double kUnits = 4.0;

/// The largest coordinate that a chain reaches without stretching, m.
double reach(const Chain& chain, const State& start) {
  const auto springs = static_cast<double>(chain.size() - 1);
  return start.positions().cwiseAbs().maxCoeff() + springs * chain.spring().rest_length;
}

}  // namespace

void checkTolerance(const Scenario& scenario, const Chain& chain, const State& start) {
  if (findMethod(scenario.method).control == StepControl::kFixed) return;
  const double least = kUnits * std::numeric_limits<double>::epsilon() * reach(chain, start);
  if (scenario.tolerance >= least) return;
  throw InputError(fmt::format(
      "tolerance: must be at least {:.1e} m for this scene, whose positions are rounded to that, "
      "got {}",
      1.05 * least, scenario.tolerance));
}

}  // namespace spring_pendulum
