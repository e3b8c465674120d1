// A chain: number of particles, masses, springs, gravity, air. Positions and time are not part of it.
#pragma once

#include <spring_pendulum/base/aligned_numbers.hpp>
#include <spring_pendulum/model/spring_law.hpp>

#include <cstddef>
#include <utility>
#include <vector>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// A particle that moves with constant acceleration, whatever its springs do. It starts with the
/// position and velocity that it has in the state.
struct HeldParticle {
  std::ptrdiff_t particle = 0;         ///< counted from 0
  PlaneVector<double> acceleration{};  ///< m/s²
};

/// A constant force on a particle.
struct AppliedForce {
  std::ptrdiff_t particle = 0;  ///< counted from 0
  PlaneVector<double> force{};  ///< N
};

/// External influences on a chain, constant in time. A motion that is driven in another way consists
/// of several intervals of constant drive. P_1 is always held; without an entry its acceleration is 0.
struct Drive {
  std::vector<HeldParticle> held;
  std::vector<AppliedForce> forces;  ///< several forces on one particle add up

  bool empty() const { return held.empty() && forces.empty(); }
};

/// What acts on every particle of a chain.
struct Constants {
  SpringLaw spring = {};
  double gravity = 9.81;  ///< g, m/s², acts along -y
  double air_drag = 0.0;  ///< k_air, N·s/m, at least 0: the air exerts the force -k_air v
};

inline bool operator==(const Constants& a, const Constants& b) {
  return a.spring == b.spring && a.gravity == b.gravity && a.air_drag == b.air_drag;
}

/// A chain of N >= 1 particles P_1..P_N and N-1 equal springs. P_1 is fixed unless a drive moves it;
/// its mass is not used. Validated by the constructor, immutable afterwards.
class Chain {
 public:
  /// \param masses an Eigen vector of N masses in kg; all finite, all but the first above 0.
  /// \throws InputError naming the value and its allowed range.
  Chain(AlignedNumbers masses, const Constants& constants);
  Chain(AlignedNumbers masses, const SpringLaw& spring, double gravity)
      : Chain(std::move(masses), Constants{spring, gravity}) {}

  /// Returns the same chain with this drive instead of its own.
  /// \throws InputError for a particle that does not exist or is held twice, a force on a held
  ///   particle, or a number that is not finite
  Chain drivenBy(Drive drive) const;

  std::ptrdiff_t size() const { return masses_.size(); }
  /// N masses, kg.
  AlignedNumbers::ConstView masses() const { return masses_.view(); }
  /// N inverse masses, 1/kg; 0 for P_1 and other held particles, which corresponds to infinite mass.
  AlignedNumbers::ConstView inverseMasses() const { return inverse_masses_.view(); }
  const Constants& constants() const { return constants_; }
  const SpringLaw& spring() const { return constants_.spring; }
  double gravity() const { return constants_.gravity; }
  double airDrag() const { return constants_.air_drag; }
  /// Whether the motion loses energy: to dashpots or to the air.
  bool isDissipative() const { return spring().damping != 0.0 || airDrag() != 0.0; }
  /// Whether only springs and gravity act: neither air nor a drive.
  bool isPlain() const { return airDrag() == 0.0 && !isDriven(); }

  const Drive& drive() const { return drive_; }
  bool isDriven() const { return !drive_.empty(); }
  bool isHeld(std::ptrdiff_t i) const { return inverse_masses_[i] == 0.0; }
  /// Returns the acceleration of particle i without springs, m/s²: that of gravity and the applied
  /// forces, or the prescribed one.
  PlaneVector<double> springlessAcceleration(std::ptrdiff_t i) const;

 private:
  AlignedNumbers masses_;
  AlignedNumbers inverse_masses_;
  Constants constants_;
  Drive drive_;
  AlignedNumbers accelerations_;  ///< springless ones, all x and then all y; empty: not driven
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
