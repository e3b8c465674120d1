// The linear systems of implicit methods for a chain, solved in O(N).
//
// An implicit method with step h and an eigenvalue λ of its inverse matrix has to solve
// (I - q J) w = b with q = h/λ and the Jacobian J of F. J = [0 I; M⁻¹K M⁻¹C], so the positions can
// be eliminated. After multiplication by the masses, a system with two unknowns per moving particle
// remains,
//
//     (M - q C - q² K) u = b ,
//
// which is block tridiagonal with 2×2 blocks. A spring adds its block q df/dw + q² df/dd to the
// diagonal blocks of its two particles and subtracts it from the two off-diagonal blocks between
// them. Air adds q k_air to the diagonal. q may be complex.
//
// Blocks are eliminated without pivoting from both ends towards the middle particle ("twisted" or
// "burn at both ends" factorisation): two independent recursions use the processor better than one.
// The order of elimination is fixed, and so are the bits.
//
// Reference: G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed., 2013, section 4.5 (block
// tridiagonal systems); J. J. Dongarra, I. S. Duff, D. C. Sorensen, H. A. van der Vorst, Numerical
// Linear Algebra for High-Performance Computers, SIAM 1998, section 7.4 (twisted factorisation).
#pragma once

#include "integration/implicit/complex.hpp"
#include "integration/implicit/linear_spring.hpp"
#include <spring_pendulum/model/chain.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace spring_pendulum {

/// Mass of a particle in these systems, kg: no spring changes the motion of a held one by a bit.
inline double massOf(const Chain& chain, Eigen::Index particle) {
  constexpr double kHeldMass = 1e30;
  return chain.isHeld(particle) ? kHeldMass : chain.masses()[particle];
}

/// \tparam Scalar double or Complex
template <typename Scalar>
class ChainSolver {
 public:
  /// \param chain must outlive the solver
  explicit ChainSolver(const Chain& chain);

  /// Factors M - q C - q² K.
  /// \param springs at least those between the particles
  /// \param q h/λ, s
  void factor(const std::vector<LinearSpring>& springs, Scalar q);

  /// Solves for one right-hand side, in place.
  /// \param x, y N entries of each component; the entry of the first particle is not used
  void solve(Scalar* x, Scalar* y) const;

 private:
  struct Block {
    Scalar xx, xy, yx, yy;
  };
  static Block product(const Block& a, const Block& b);
  static Block inverse(const Block& a);

  /// q df/dw + q² df/dd of spring i; 0 beyond the free end.
  Block springBlock(Eigen::Index i) const;
  Block diagonal(Eigen::Index particle) const;
  /// Eliminates particle `from` from the row of the neighbour that `spring` joins it to.
  void eliminate(Eigen::Index from, const Block& spring, Block& neighbour, Block& forward);

  const Chain& chain_;
  const std::vector<LinearSpring>* springs_ = nullptr;
  Scalar q_{};
  std::vector<Block> pivots_;    ///< inverse diagonal block of particle i at its elimination
  std::vector<Block> forward_;   ///< factor of the outer neighbour's right-hand side
  std::vector<Block> backward_;  ///< factor of the inner neighbour's solution
  Block forward_middle_{};       ///< like forward_[middle_], but for the right neighbour
};

extern template class ChainSolver<double>;
extern template class ChainSolver<Complex>;

}  // namespace spring_pendulum
