#include "base/checks.hpp"

#include "base/numbers.hpp"

#include <fmt/format.h>

#include <cmath>

namespace spring_pendulum {

void requireSize(std::ptrdiff_t of_chain, std::ptrdiff_t of_state) {
  if (of_state == of_chain) return;
  throw InputError(fmt::format(
      "the state has {} particles but the chain has {}; the sizes must agree", of_state, of_chain));
}

void requireAdvance(std::ptrdiff_t of_chain, std::ptrdiff_t of_state, double time_step,
                    std::int64_t steps) {
  requireSize(of_chain, of_state);
  requirePositive("time_step", time_step, "s");
  requireAtLeastZero("steps", steps);
}

void requirePositive(const char* name, double value, const char* unit, bool or_zero) {
  if (std::isfinite(value) && (value > 0.0 || (or_zero && value == 0.0))) return;
  throw InputError(fmt::format("{} must be finite and {} 0 {}, got {}", name,
                               or_zero ? "at least" : "above", unit, numberText(value)));
}

void requireAtLeastZero(const char* name, std::ptrdiff_t value) {
  if (value >= 0) return;
  throw InputError(fmt::format("{} must be at least 0, got {}", name, value));
}

}  // namespace spring_pendulum
