#include "simulation/energy_balance.hpp"

#include "base/checks.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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
      start_energy_(computeEnergy(chain, start).total()),
      start_height_(start.y()[0]) {
  widenScale(start, start_energy_);
}

double EnergyBalance::change(const Chain& chain, const State& before, const State& after,
                             bool track_dissipation, double supplied) {
  const double energy_before = energyOf(before).total();
  chain_ = chain;
  track_dissipation_ = track_dissipation;
  changed_ = true;
  const double energy_after = energyOf(after).total();
  widenScale(after, energy_after);
  const double supplied_after = supplied + energy_after - energy_before;
  most_supplied_ = std::max({most_supplied_, std::abs(supplied), std::abs(supplied_after)});
  return supplied_after;
}

void EnergyBalance::widenScale(const State& start, double energy) {
  requireSize(chain_.size(), start.size());
  const SpringLaw& spring = chain_.spring();
  // Sums from the free end: weight beyond a spring, -E_min, and springs that are hardly stretched.
  double weight = 0.0, depth = 0.0, least = 0.0;
  for (Eigen::Index i = chain_.size() - 1; i > 0; --i) {
    weight += chain_.masses()[i] * std::abs(chain_.gravity());
    depth += weight * spring.rest_length;
    if (spring.stiffness > 0.0) depth += 0.5 * weight * weight / spring.stiffness;
    const double stretch = kLeastStretch * std::max(spring.rest_length, springLength(start, i - 1));
    least += 0.5 * spring.stiffness * stretch * stretch;
  }
  if (spring.stiffness == 0.0) fall_ = 0.5 * weight * std::abs(chain_.gravity());
  constant_scale_ = std::max({constant_scale_, std::max(energy, 0.0) + depth, least});
  if (!std::isfinite(energy) || !std::isfinite(constant_scale_) || !std::isfinite(fall_)) {
    throw InputError(
        "the initial energy exceeds the range of a double: masses, lengths, stiffness or "
        "gravity must be smaller");
  }
}

Energy EnergyBalance::energyOf(const State& state) const {
  Energy energy = computeEnergy(chain_, state);
  const double raised = state.y()[0] - start_height_;
  if (raised == 0.0) return energy;
  for (Eigen::Index i = 1; i < chain_.size(); ++i) {
    if (!chain_.isHeld(i)) energy.gravity += chain_.masses()[i] * chain_.gravity() * raised;
  }
  return energy;
}

double EnergyBalance::scale(double time) const {
  const double elapsed = time - start_time_;
  return std::max(constant_scale_ + fall_ * elapsed * elapsed, std::numeric_limits<double>::min());
}

EnergyEntry EnergyBalance::entry(double time, const State& state, double dissipated,
                                 double supplied) const {
  EnergyEntry entry;
  entry.time = time;
  entry.energy = energyOf(state);
  entry.supplied = supplied;
  entry.gain = entry.energy.total() - start_energy_ - supplied;
  // Energy that is taken back leaves its rounding and step errors in the chain.
  const double scale_now = scale(time) + std::max(most_supplied_, std::abs(supplied));
  entry.relative_gain = entry.gain / scale_now;
  if (track_dissipation_) entry.dissipated = dissipated;
  if (!chain_.isDissipative() && !changed_) entry.dissipated = 0.0;
  if (entry.dissipated) {
    entry.residual = entry.gain + *entry.dissipated;
    entry.relative_residual = *entry.residual / scale_now;
  }
  return entry;
}

}  // namespace spring_pendulum
