#include "base/numbers.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

/// Factor by which the forces and the motion amplify the rounding errors of the steps.
constexpr double kRoundingErrors = 100.0;

}  // namespace

double smallestTolerance(const Chain& chain, const State& start) {
  const double length = chain.spring().rest_length * static_cast<double>(chain.size() - 1);
  double largest = std::abs(chain.gravity());  // times (1 s)²: a length in m
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    largest = std::max({largest, std::abs(start.x()[i]), std::abs(start.y()[i]),
                        std::abs(start.vx()[i]), std::abs(start.vy()[i])});
  }
  return kRoundingErrors * std::numeric_limits<double>::epsilon() * std::max(length, largest);
}

void checkTolerance(double tolerance, const Chain& chain, const State& start) {
  const double least = smallestTolerance(chain, start);
  if (tolerance >= least) return;
  throw InputError(
      fmt::format("tolerance: must be at least {:.1e} m for this scene, because of the rounding "
                  "errors of its positions; got {}",
                  1.05 * least, numberText(tolerance)));
}

}  // namespace spring_pendulum
