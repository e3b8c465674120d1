#include "integration/tableau.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <fmt/format.h>

#include <cmath>

namespace spring_pendulum {
namespace {

constexpr int kMostOrder = 10;
/// Violation of an order condition that rounded coefficients may have.
constexpr double kRounding = 1e-12;
/// Growth per step that counts as none.
constexpr double kNoGrowth = 1e-12;
constexpr double kScanStep = 0.01;
constexpr double kLargestLimit = 1000.0;

int orderOf(const ButcherTableau& tableau) {
  int order = 0;
  while (order < kMostOrder && orderConditionResidual(tableau, tableau.b, order + 1) <= kRounding) {
    ++order;
  }
  return order;
}

/// Returns the largest h|λ| up to which no mode λ of this direction grows; 0: none.
double stabilityLimit(const ButcherTableau& tableau, std::complex<double> direction) {
  const auto is_stable = [&](double size) {
    return growthOf(stabilityIncrement(tableau, size * direction)) <= kNoGrowth;
  };
  double stable = 0.0;
  while (stable < kLargestLimit && is_stable(stable + kScanStep)) stable += kScanStep;
  if (stable == 0.0) return 0.0;
  double unstable = stable + kScanStep;
  while (unstable - stable > 1e-12 * unstable) {
    const double middle = 0.5 * (stable + unstable);
    (is_stable(middle) ? stable : unstable) = middle;
  }
  return stable;
}

}  // namespace

void checkTableau(std::string_view method, const ButcherTableau& tableau) {
  if (tableau.stages < 1 || tableau.stages > ButcherTableau::kMaxStages) {
    throw InputError(fmt::format("tableau of method '{}' has {} stages: must be 1 to {}", method,
                                 tableau.stages, ButcherTableau::kMaxStages));
  }
  for (std::size_t i = 0; i < tableau.stages; ++i) {
    bool explicit_row = std::isfinite(tableau.b[i]);
    for (std::size_t j = 0; j < tableau.stages; ++j) {
      explicit_row =
          explicit_row && (j < i ? std::isfinite(tableau.a[i][j]) : tableau.a[i][j] == 0.0);
    }
    if (explicit_row) continue;
    throw InputError(
        fmt::format("stage {} of the tableau of method '{}': coefficients must be finite, and 0 on "
                    "and above the diagonal",
                    i + 1, method));
  }
  if (orderConditionResidual(tableau, tableau.b, 1) <= kRounding) return;
  throw InputError(fmt::format("method '{}': the weights b must add up to 1", method));
}

Method methodOfTableau(const std::string& name, const ButcherTableau& tableau) {
  checkTableau(name, tableau);
  Method method;
  method.name = name;
  method.order = orderOf(tableau);
  method.stages = static_cast<int>(tableau.stages);
  method.real_stability_limit = stabilityLimit(tableau, -1.0);
  method.imaginary_stability_limit = stabilityLimit(tableau, {0.0, 1.0});
  method.tableau = &tableau;
  return method;
}

}  // namespace spring_pendulum
