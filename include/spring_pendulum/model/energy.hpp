// The energies of a chain and the power dissipated by its dashpots.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>

#include <optional>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Energies of one state, J. Each sum has a fixed order, so the bits are the same on every machine.
struct Energy {
  double kinetic = 0.0;  ///< sum of m v²/2; held particles count as massless here and below
  double gravity = 0.0;  ///< sum of m g (y - y_1): 0 at the height of the fixed particle
  double spring = 0.0;   ///< sum of k_s (L - L_0)²/2, without springs between two held particles

  double total() const { return kinetic + gravity + spring; }
};

/// The energy balance E(t) + D(t) - S(t) = E(0) of a state, with the dissipated energy D and the energy S
/// that a drive has supplied. Energies in J, relative values in units of the energy scale.
struct EnergyEntry {
  double time = 0.0;                 ///< s
  Energy energy;                     ///< not finite if the state is not
  double supplied = 0.0;             ///< S(t)
  double gain = 0.0;                 ///< E(t) - E(0) - S(t)
  double scale = 0.0;                ///< energy scale of the run so far
  double relative_gain = 0.0;        ///< gain / scale
  std::optional<double> dissipated;  ///< nothing if not tracked
  std::optional<double> residual;    ///< E(t) + D(t) - E(0) - S(t)
  std::optional<double> relative_residual;
};

/// Computes the energies of a state.
/// \throws InputError if the size of the state is not that of the chain
Energy computeEnergy(const Chain& chain, const State& state);

/// Returns the power dissipated by the dashpots and the air, the sum of k_d (w·r)² of all springs that are
/// not between two held particles, and of k_air v² of all particles that are not held, W; never negative.
/// \throws InputError if the size of the state is not that of the chain
double dissipatedPower(const Chain& chain, const State& state);

}  // namespace spring_pendulum
#pragma GCC visibility pop
