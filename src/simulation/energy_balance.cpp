#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/simulation/energy_balance.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

/// The least energy scale is that of all springs stretched by this share of their length.
constexpr double kLeastStretch = 1e-6;

}  // namespace

EnergyBalance::EnergyBalance(const Chain& chain, const State& start, bool track_dissipation,
                             double start_time)
    : chain_(chain),
      start_time_(start_time),
      track_dissipation_(track_dissipation),
      start_energy_(computeEnergy(chain, start).total()) {
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
  constant_scale_ = std::max(std::max(start_energy_, 0.0) + depth, least);
  if (!std::isfinite(start_energy_) || !std::isfinite(constant_scale_) || !std::isfinite(fall_)) {
    throw InputError(
        "the initial energy exceeds the range of a double: masses, lengths, stiffness or "
        "gravity must be smaller");
  }
}

double EnergyBalance::scale(double time) const {
  const double elapsed = time - start_time_;
  return std::max(constant_scale_ + fall_ * elapsed * elapsed, std::numeric_limits<double>::min());
}

EnergyEntry EnergyBalance::entry(double time, const State& state, double dissipated) const {
  EnergyEntry entry;
  entry.time = time;
  entry.energy = computeEnergy(chain_, state);
  entry.gain = entry.energy.total() - start_energy_;
  entry.relative_gain = entry.gain / scale(time);
  if (track_dissipation_) entry.dissipated = dissipated;
  if (chain_.spring().damping == 0.0) entry.dissipated = 0.0;
  if (entry.dissipated) {
    entry.residual = entry.gain + *entry.dissipated;
    entry.relative_residual = *entry.residual / scale(time);
  }
  return entry;
}

}  // namespace spring_pendulum
