// The constants of a chain: number of particles, masses, springs and gravity. Positions and time
// are not part of it.
#pragma once

#include <spring_pendulum/base/aligned_numbers.hpp>
#include <spring_pendulum/model/drive.hpp>
#include <spring_pendulum/model/spring_law.hpp>

#include <cstddef>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// A chain of N >= 1 particles P_1..P_N and N-1 equal springs. P_1 is fixed unless a drive moves it;
/// its mass is not used. Validated by the constructor, immutable afterwards.
class Chain {
 public:
  /// \param masses  an Eigen vector of N masses in kg; all but the first finite and above 0.
  /// \param spring  stiffness, damping and rest length, each finite and at least 0.
  /// \param gravity g in m/s², finite; acts along -y.
  /// \throws InputError naming the value and its allowed range.
  Chain(AlignedNumbers masses, const SpringLaw& spring, double gravity);

  /// Returns the same chain with this drive instead of its own.
  /// \throws InputError for a particle that does not exist or is held twice, a force on a held
  ///   particle, or a number that is not finite
  Chain drivenBy(Drive drive) const;

  /// Returns the same chain in air, which exerts the force -k_air v on every particle that moves freely.
  /// \param drag k_air in N·s/m, finite and at least 0
  /// \throws InputError for a drag out of this range
  Chain inAir(double drag) const;

  std::ptrdiff_t size() const { return masses_.size(); }
  /// N masses, kg.
  AlignedNumbers::ConstView masses() const { return masses_.view(); }
  /// N inverse masses, 1/kg; 0 for P_1 and other held particles, which corresponds to infinite mass.
  AlignedNumbers::ConstView inverseMasses() const { return inverse_masses_.view(); }
  const SpringLaw& spring() const { return spring_; }
  double gravity() const { return gravity_; }
  double airDrag() const { return air_drag_; }
  /// Whether the motion loses energy: to dashpots or to the air.
  bool isDissipative() const { return spring_.damping != 0.0 || air_drag_ != 0.0; }
  /// Whether only springs and gravity act: neither air nor a drive.
  bool isPlain() const { return air_drag_ == 0.0 && !isDriven(); }
  /// Whether all moving particles have exactly the same mass.
  bool equalMasses() const { return equal_masses_; }

  const Drive& drive() const { return drive_; }
  bool isDriven() const { return !drive_.empty(); }
  bool isHeld(std::ptrdiff_t i) const { return inverse_masses_[i] == 0.0; }
  /// Returns the acceleration of particle i without springs, m/s²: that of gravity and the applied
  /// forces, or the prescribed one.
  PlaneVector<double> springlessAcceleration(std::ptrdiff_t i) const;

 private:
  AlignedNumbers masses_;
  AlignedNumbers inverse_masses_;
  SpringLaw spring_;
  double gravity_;
  double air_drag_ = 0.0;
  bool equal_masses_;
  Drive drive_;
  AlignedNumbers accelerations_;  ///< springless ones, all x and then all y; empty: not driven
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
