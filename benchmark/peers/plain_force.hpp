// The right-hand side of all library peers: a plain structure-of-arrays loop, compiled with the
// vector flags of the machine.
#pragma once

#include "../peer.hpp"

namespace spring_pendulum::benchmark {

class PlainForce {
 public:
  explicit PlainForce(const Problem& problem);

  /// z' = F(z); z and z' hold x, y, vx, vy, each N numbers.
  void operator()(const double* state, double* derivative);

  /// The same for a state with the four numbers of a particle adjacent, for which the Jacobian is
  /// banded with 7 lower and 5 upper diagonals.
  void interleaved(const double* state, double* derivative);

  /// The banded Jacobian of `interleaved`, at least 12 diagonals: entry (row, column) is
  /// columns[column][row - column], as SUNDIALS stores band matrices.
  void interleavedJacobian(const double* state, double* const* columns) const;

  std::size_t size() const { return size_; }
  /// Computes only the forces.
  void springForces(const double* state);
  const double* forceX() const {
    return force_x_.data();
  }  ///< N, of spring i on particle i; last 0
  const double* forceY() const { return force_y_.data(); }
  const double* inverseMasses() const { return inverse_masses_.data(); }
  double gravity() const { return gravity_; }

  std::int64_t evaluations() const { return evaluations_; }

 private:
  std::size_t size_;
  double stiffness_, damping_, rest_length_, gravity_;
  std::vector<double> inverse_masses_;
  std::vector<double> force_x_, force_y_;  ///< of spring i on particle i, N
  std::vector<double> sorted_, sorted_derivative_;
  std::int64_t evaluations_ = 0;
};

/// Converts a structure of arrays to adjacent x y vx vy of each particle, and back.
void interleave(std::size_t size, const double* arrays, double* interleaved);
void separate(std::size_t size, const double* interleaved, double* arrays);

}  // namespace spring_pendulum::benchmark
