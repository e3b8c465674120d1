// The energy balance of a run.
//
// E(t) + D(t) - S(t) = E(0) at all times, with the energy E = kinetic + gravity + spring, the
// dissipated energy D and the energy S that holders of particles and applied forces have supplied; S is
// 0 unless the chain is driven. The residual E(t) + D(t) - S(t) - E(0) is the integration error of a
// quantity whose exact value is known. It is given relative to the energy scale of the scene.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/energy.hpp>
#include <spring_pendulum/model/state.hpp>

namespace spring_pendulum {

/// Computes the balance of states of one motion, relative to the energy scale. The scale is the energy
/// available to the motion: the difference between the larger of E(0) and 0 (all springs unstretched
/// and all particles at the height of P_1) and the minimum, the chain hanging at rest, where spring i
/// carries the weight W_i of all particles beyond it:
///
///     scale = max(E(0), 0) - E_min ,   E_min = -sum( W_i L_0 + W_i²/(2 k_s) )
///
/// For a chain that starts in equilibrium, this is the energy of lifting it to the height of P_1.
/// The largest supplied energy so far adds to the scale. Two rules keep the scale positive and finite:
/// - it is at least the energy of all springs stretched by a millionth of their length;
/// - without stiffness (k_s = 0) there is no minimum, and M g² t²/2, the energy of the free fall of
///   the mass M until time t, replaces the last term.
class EnergyBalance {
 public:
  /// \param track_dissipation whether the integrator has `track_dissipation` set. If not, the
  ///   residual is known only for a chain without damping.
  /// \param start_time time of the start, s
  /// \throws InputError if an energy of the start exceeds the range of double
  EnergyBalance(const Chain& chain, const State& start, bool track_dissipation,
                double start_time = 0.0);
  /// Returns the balance of a state.
  /// \param time       s, at least the start time
  /// \param dissipated `Integrator::dissipatedEnergy()`, J; used only if tracked
  /// \param supplied   `Integrator::suppliedEnergy()`, J
  EnergyEntry entry(double time, const State& state, double dissipated,
                    double supplied = 0.0) const;

  /// Continues with another chain of as many particles, and from another state.
  /// \param track_dissipation whether the dissipated energy is known from the start on
  /// \param supplied          energy supplied before the change, J
  /// \returns the energy supplied until after the change, J: it includes the difference of the energies
  /// \throws InputError if an energy exceeds the range of double
  double change(const Chain& chain, const State& before, const State& after, bool track_dissipation,
                double supplied);

  const Chain& chain() const { return chain_; }
  /// Energy scale at a time in s, J; positive.
  double scale(double time) const;

 private:
  /// Returns the energy of a state, with the height of P_1 at the start as height 0 of all states.
  Energy energyOf(const State& state) const;
  void widenScale(const State& start, double energy);

  Chain chain_;
  double start_time_;  ///< s
  bool track_dissipation_;
  bool changed_ = false;
  double start_energy_;          ///< J
  double start_height_ = 0.0;    ///< of P_1, m
  double constant_scale_ = 0.0;  ///< J
  double fall_ = 0.0;            ///< scale of the free fall, J/s²
  double most_supplied_ = 0.0;   ///< largest amount at a change, J
};

}  // namespace spring_pendulum
