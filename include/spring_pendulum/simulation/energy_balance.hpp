// The energy balance of a run: where the energy is, what the dashpots took, and what is missing.
//
// Nothing drives the chain, so E(t) + D(t) = E(0) at all times, with the energy E = kinetic +
// gravity + spring and the energy D that the dashpots dissipated. The residual E(t) + D(t) - E(0)
// is the integration error in the one quantity that is known exactly. It is put in relation to the
// energy scale of the scene.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/energy.hpp>
#include <spring_pendulum/model/export.hpp>
#include <spring_pendulum/model/state.hpp>

#include <optional>

namespace SPRING_PENDULUM_API spring_pendulum {

/// The energy in J that a scene can turn over: from the larger of E(0) and 0 (the level of all
/// particles unstretched at the height of P_1) down to the least energy there is, the chain hanging
/// at rest, where spring i carries the weight W_i of all particles beyond it:
///
///     scale = max(E(0), 0) - E_min ,   E_min = -sum( W_i L_0 + W_i²/(2 k_s) )
///
/// So a chain that starts at rest in equilibrium still has the scale of lifting it to the height of
/// P_1. Two special cases keep it above zero and finite:
/// - it is never below the energy of all springs stretched by a millionth of their length;
/// - without stiffness (k_s = 0) no least energy exists, and M g² t²/2 takes the place of the last
///   term: what the fall of the mass M has turned over at time t.
class EnergyScale {
 public:
  /// \throws InputError if the energies of the start do not fit into a double
  EnergyScale(const Chain& chain, const State& start);

  /// J, above 0 for any chain with springs.
  double at(double time) const { return constant_ + fall_ * time * time; }

 private:
  double constant_ = 0.0;  ///< J
  double fall_ = 0.0;      ///< J/s²
};

/// One row of the energy balance. Energies in J, relative numbers in parts of the energy scale.
struct EnergyEntry {
  double time = 0.0;                 ///< s
  Energy energy;                     ///< not finite if the state is not
  double gain = 0.0;                 ///< E(t) - E(0)
  double relative_gain = 0.0;        ///< gain / scale
  std::optional<double> dissipated;  ///< nothing if nobody tracked it
  std::optional<double> residual;    ///< E(t) + D(t) - E(0)
  std::optional<double> relative_residual;
};

class EnergyBalance {
 public:
  /// \param tracks_dissipation whether the integrator was made with `track_dissipation`. Without,
  ///   the residual is known only if the chain has no damping, and then costs nothing.
  /// \throws InputError as EnergyScale
  EnergyBalance(const Chain& chain, const State& start, bool tracks_dissipation);

  /// One pass over the state.
  /// \param time       s since the start
  /// \param dissipated `Integrator::dissipatedEnergy()`, J; read only if it is tracked
  EnergyEntry entry(double time, const State& state, double dissipated) const;

  /// Energy scale at a time, J.
  double scale(double time) const { return scale_.at(time); }

 private:
  Chain chain_;
  EnergyScale scale_;
  double start_energy_;
  bool tracks_dissipation_;
};

}  // namespace spring_pendulum
