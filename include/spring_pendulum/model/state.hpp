// Where the particles are and how fast they move: the unknown z = [p; v] of z' = F(z).
#pragma once

#include <Eigen/Core>

namespace spring_pendulum {

/// Positions (m) and velocities (m/s) of N particles as a structure of arrays: an N×4 matrix whose
/// columns x, y, vx, vy are each contiguous. Plain data: no clock, no invariants.
class State {
 public:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, 4>;

  State() = default;
  /// N particles at the origin, at rest.
  explicit State(Eigen::Index particles) : values_(Matrix::Zero(particles, 4)) {}

  Eigen::Index size() const { return values_.rows(); }

  auto x() { return values_.col(0); }
  auto y() { return values_.col(1); }
  auto vx() { return values_.col(2); }
  auto vy() { return values_.col(3); }
  auto x() const { return values_.col(0); }
  auto y() const { return values_.col(1); }
  auto vx() const { return values_.col(2); }
  auto vy() const { return values_.col(3); }

  /// N×2: x and y.
  auto positions() { return values_.leftCols<2>(); }
  auto positions() const { return values_.leftCols<2>(); }
  /// N×2: vx and vy.
  auto velocities() { return values_.rightCols<2>(); }
  auto velocities() const { return values_.rightCols<2>(); }

  /// N×4, columns x, y, vx, vy.
  Matrix& values() { return values_; }
  const Matrix& values() const { return values_; }

 private:
  Matrix values_;
};

}  // namespace spring_pendulum
