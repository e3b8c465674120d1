#include "base/checks.hpp"
#include "base/numbers.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace spring_pendulum {
Chain::Chain(AlignedNumbers masses, const SpringLaw& spring, double gravity)
    : masses_(std::move(masses)), spring_(spring), gravity_(gravity) {
  if (masses_.size() < 1) throw InputError("a chain needs at least one particle, the fixed one");
  requireFiniteAtLeastZero("stiffness", spring.stiffness, "N/m");
  requireFiniteAtLeastZero("damping", spring.damping, "N·s/m");
  requireFiniteAtLeastZero("rest_length", spring.rest_length, "m");
  if (!std::isfinite(gravity)) {
    throw InputError(
        fmt::format("gravity must be a finite number in m/s², got {}", numberText(gravity)));
  }
  for (std::ptrdiff_t i = 1; i < masses_.size(); ++i) {
    if (std::isfinite(masses_[i]) && masses_[i] > 0.0 && std::isfinite(1.0 / masses_[i])) continue;
    throw InputError(fmt::format("mass of particle {} must be above 0 kg and 1/mass finite, got {}",
                                 i + 1, numberText(masses_[i])));
  }
  inverse_masses_ = masses_.view().cwiseInverse();
  inverse_masses_[0] = 0.0;
  equal_masses_ = size() < 3 || (masses_.view().tail(size() - 1).array() == masses_[1]).all();
}

Chain::Chain(const Chain& other) = default;
Chain::Chain(Chain&& other) noexcept = default;
Chain& Chain::operator=(const Chain& other) = default;
Chain& Chain::operator=(Chain&& other) noexcept = default;
Chain::~Chain() = default;

}  // namespace spring_pendulum
