// The constants of a chain: number of particles, masses, springs and gravity. Positions and time
// are not part of it.
#pragma once

#include <spring_pendulum/base/aligned_numbers.hpp>
#include <spring_pendulum/model/spring_law.hpp>

#include <cstddef>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// A chain of N >= 1 particles P_1..P_N and N-1 equal springs. P_1 is fixed; its mass is not used.
/// Validated by the constructor, immutable afterwards.
class Chain {
 public:
  /// \param masses  an Eigen vector of N masses in kg; all but the first finite and above 0.
  /// \param spring  stiffness, damping and rest length, each finite and at least 0.
  /// \param gravity g in m/s², finite; acts along -y.
  /// \throws InputError naming the value and its allowed range.
  Chain(AlignedNumbers masses, const SpringLaw& spring, double gravity);
  Chain(const Chain& other);
  Chain(Chain&& other) noexcept;
  Chain& operator=(const Chain& other);
  Chain& operator=(Chain&& other) noexcept;
  ~Chain();

  std::ptrdiff_t size() const { return masses_.size(); }
  /// N masses, kg.
  AlignedNumbers::ConstView masses() const { return masses_.view(); }
  /// N inverse masses, 1/kg; 0 for P_1, which corresponds to infinite mass.
  AlignedNumbers::ConstView inverseMasses() const { return inverse_masses_.view(); }
  const SpringLaw& spring() const { return spring_; }
  double gravity() const { return gravity_; }
  /// Whether all moving particles have exactly the same mass.
  bool equalMasses() const { return equal_masses_; }

 private:
  AlignedNumbers masses_;
  AlignedNumbers inverse_masses_;
  SpringLaw spring_;
  double gravity_;
  bool equal_masses_;
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
