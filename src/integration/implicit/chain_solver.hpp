// The linear systems of implicit methods for a chain, solved in O(N).
//
// An implicit method with step h and coefficient γ has to solve (I - q J) w = r with q = hγ and J
// the Jacobian of F. J has the shape [0 I; K C], so the positions can be eliminated; with the
// masses multiplied in there remains, for two unknowns a moving particle,
//
//     (M - q C - q² K) u = b ,
//
// block tridiagonal with 2×2 blocks: a spring adds its block q dfdw + q² dfdd to the diagonal
// blocks of its two ends and takes it off the two blocks that join them.
//
// Blocks are eliminated without pivoting from both ends at once towards the middle particle
// ("twisted" or "burn at both ends" factorisation): two independent recursions keep the processor
// busier than one. The order of elimination is fixed, so are the bits.
//
// Reference: G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed., 2013, section 4.5 (block
// tridiagonal systems); J. J. Dongarra, I. S. Duff, D. C. Sorensen, H. A. van der Vorst, Numerical
// Linear Algebra for High-Performance Computers, SIAM 1998, section 7.4 (twisted factorisation).
#pragma once

#include "model/jacobian.hpp"
#include <spring_pendulum/model/chain.hpp>

#include <Eigen/Core>

#include <vector>

namespace spring_pendulum {

class ChainSolver {
 public:
  explicit ChainSolver(const Chain& chain);

  /// Factors M - q C - q² K.
  /// \param q hγ, s
  void factor(const SpringJacobian& jacobian, double q);

  /// Solves for one right-hand side, in place.
  /// \param x, y the N entries of a component; those of the fixed first particle are not touched
  void solve(double* x, double* y) const;

 private:
  struct Block {
    double xx, xy, yx, yy;
  };
  static Block product(const Block& a, const Block& b);
  static Block inverse(const Block& a);

  Block diagonal(Eigen::Index particle) const;
  /// Takes out what eliminating `from` does to its neighbour, to which `spring` joins it.
  void eliminate(Eigen::Index from, const Block& spring, Block& neighbour, Block& forward);

  Eigen::VectorXd masses_;
  Eigen::Index middle_;         ///< particle eliminated last
  std::vector<Block> springs_;  ///< q dfdw + q² dfdd of spring i; one more, 0, behind the free end
  std::vector<Block> pivots_;   ///< inverse diagonal block of particle i when its turn has come
  std::vector<Block> forward_;  ///< what particle i takes of its outer neighbour's right-hand side
  std::vector<Block> backward_;  ///< what particle i takes of its inner neighbour's solution
  Block forward_middle_{};       ///< as forward_[middle_], which is from the left, from the right
};

}  // namespace spring_pendulum
