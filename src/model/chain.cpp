#include "base/checks.hpp"
#include "base/numbers.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <utility>

namespace spring_pendulum {
namespace {

/// Checks an entry of a drive.
void requireEntry(std::ptrdiff_t size, std::ptrdiff_t particle, const char* what,
                  const PlaneVector<double>& value) {
  if (particle < 0 || particle >= size) {
    throw InputError(fmt::format("particle {} does not exist: the chain has particles 1 to {}",
                                 particle + 1, size));
  }
  if (std::isfinite(value.x) && std::isfinite(value.y)) return;
  throw InputError(fmt::format("{} of particle {} must be finite, got ({}, {})", what, particle + 1,
                               numberText(value.x), numberText(value.y)));
}

}  // namespace

Chain::Chain(AlignedNumbers masses, const Constants& constants)
    : masses_(std::move(masses)), constants_(constants) {
  if (masses_.size() < 1) throw InputError("a chain needs at least one particle, the fixed one");
  requirePositive("stiffness", constants.spring.stiffness, "N/m", true);
  requirePositive("damping", constants.spring.damping, "N·s/m", true);
  requirePositive("rest_length", constants.spring.rest_length, "m", true);
  requirePositive("air_drag", constants.air_drag, "N·s/m", true);
  if (!std::isfinite(constants.gravity))
    throw InputError(fmt::format("gravity must be a finite number in m/s², got {}",
                                 numberText(constants.gravity)));
  if (!std::isfinite(masses_[0])) throw InputError("mass of particle 1 must be finite");
  for (std::ptrdiff_t i = 1; i < masses_.size(); ++i) {
    if (std::isfinite(masses_[i]) && masses_[i] > 0.0 && std::isfinite(1.0 / masses_[i])) continue;
    throw InputError(fmt::format("mass of particle {} must be above 0 kg and 1/mass finite, got {}",
                                 i + 1, numberText(masses_[i])));
  }
  inverse_masses_ = masses_.view().cwiseInverse();
  inverse_masses_[0] = 0.0;
}

Chain Chain::drivenBy(Drive drive) const {
  Chain chain(masses_, constants_);
  if (drive.empty()) return chain;
  const std::ptrdiff_t size = chain.size();
  chain.accelerations_ = AlignedNumbers(2 * size);
  double* x = chain.accelerations_.data();
  double* y = x + size;
  for (std::ptrdiff_t i = 1; i < size; ++i) y[i] = -gravity();
  std::set<std::ptrdiff_t> held;
  for (const auto& [particle, acceleration] : drive.held) {
    requireEntry(size, particle, "acceleration", acceleration);
    if (!held.insert(particle).second)
      throw InputError(fmt::format("particle {} is held twice", particle + 1));
    chain.inverse_masses_[particle] = 0.0;
    x[particle] = acceleration.x;
    y[particle] = acceleration.y;
  }
  for (const auto& [particle, force] : drive.forces) {
    requireEntry(size, particle, "force", force);
    if (chain.isHeld(particle))
      throw InputError(fmt::format("particle {} is held: a force would not move it", particle + 1));
    x[particle] += force.x * chain.inverse_masses_[particle];
    y[particle] += force.y * chain.inverse_masses_[particle];
  }
  chain.drive_ = std::move(drive);
  return chain;
}

PlaneVector<double> Chain::springlessAcceleration(std::ptrdiff_t i) const {
  if (isDriven()) return {accelerations_[i], accelerations_[size() + i]};
  return {0.0, i == 0 ? 0.0 : -gravity()};
}

}  // namespace spring_pendulum
