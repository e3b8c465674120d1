#include "base/checks.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/simulation/energy_balance.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

/// Stretch of all springs, relative to their length, whose energy is the least energy scale.
constexpr double kLeastStretch = 1e-6;

}  // namespace

EnergyScale::EnergyScale(const Chain& chain, const State& start) {
  requireSize(chain.size(), start.size());
  const SpringLaw& spring = chain.spring();
  double depth = 0.0;  // -E_min, J
  double least = 0.0;
  double weight = 0.0;
  for (Eigen::Index i = chain.size() - 1; i > 0; --i) {
    weight += chain.masses()[i] * std::abs(chain.gravity());
    depth += weight * spring.rest_length;
    if (spring.stiffness > 0.0) depth += 0.5 * weight * weight / spring.stiffness;
    const double stretch = kLeastStretch * std::max(spring.rest_length, springLength(start, i - 1));
    least += 0.5 * spring.stiffness * stretch * stretch;
  }
  if (spring.stiffness == 0.0) fall_ = 0.5 * weight * std::abs(chain.gravity());
  const double energy = computeEnergy(chain, start).total();
  constant_ = std::max(std::max(energy, 0.0) + depth, least);
  if (!std::isfinite(energy) || !std::isfinite(constant_) || !std::isfinite(fall_)) {
    throw InputError(
        "the initial energy exceeds the range of a double: masses, lengths, stiffness or "
        "gravity must be smaller");
  }
}

EnergyBalance::EnergyBalance(const Chain& chain, const State& start, bool tracks_dissipation)
    : chain_(chain),
      scale_(chain, start),
      start_energy_(computeEnergy(chain, start).total()),
      tracks_dissipation_(tracks_dissipation) {}

EnergyEntry EnergyBalance::entry(double time, const State& state, double dissipated) const {
  const double scale = std::max(scale_.at(time), std::numeric_limits<double>::min());
  EnergyEntry entry;
  entry.time = time;
  entry.energy = computeEnergy(chain_, state);
  entry.gain = entry.energy.total() - start_energy_;
  entry.relative_gain = entry.gain / scale;
  if (tracks_dissipation_) entry.dissipated = dissipated;
  if (chain_.spring().damping == 0.0) entry.dissipated = 0.0;
  if (entry.dissipated) {
    entry.residual = entry.gain + *entry.dissipated;
    entry.relative_residual = *entry.residual / scale;
  }
  return entry;
}

}  // namespace spring_pendulum
