// Positions and velocities of all particles: the unknown z = [p; v] of z' = F(z).
#pragma once

#include <spring_pendulum/base/aligned_numbers.hpp>

#include <Eigen/Core>

#include <cstddef>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Positions (m) and velocities (m/s) of N particles as a structure of arrays: an N×4 matrix whose
/// columns x, y, vx, vy are each contiguous. Plain data without time and without invariants.
///
/// The state owns the numbers. The member functions return Eigen views, which are valid until the
/// state is destroyed, moved from or assigned a state of another size. An assignment allocates only if
/// the sizes differ.
class State {
 public:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, 4>;

  State() = default;
  /// Places N particles at the origin, at rest.
  /// \throws InputError if `particles` is negative
  explicit State(std::ptrdiff_t particles);

  /// Number of particles N.
  std::ptrdiff_t size() const { return numbers_.size() / 4; }

  /// N×4, columns x, y, vx, vy.
  auto values() { return Eigen::Map<Matrix>(numbers_.data(), size(), 4); }
  auto values() const { return Eigen::Map<const Matrix>(numbers_.data(), size(), 4); }

  auto x() { return values().col(0); }
  auto y() { return values().col(1); }
  auto vx() { return values().col(2); }
  auto vy() { return values().col(3); }
  auto x() const { return values().col(0); }
  auto y() const { return values().col(1); }
  auto vx() const { return values().col(2); }
  auto vy() const { return values().col(3); }

  /// N×2: x and y.
  auto positions() { return values().leftCols<2>(); }
  auto positions() const { return values().leftCols<2>(); }
  /// N×2: vx and vy.
  auto velocities() { return values().rightCols<2>(); }
  auto velocities() const { return values().rightCols<2>(); }

 private:
  AlignedNumbers numbers_;  ///< column by column
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
