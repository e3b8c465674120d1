#include "integration/implicit/chain_solver.hpp"

namespace spring_pendulum {

ChainSolver::ChainSolver(const Chain& chain)
    : masses_(chain.masses()),
      middle_(chain.size() / 2),
      springs_(static_cast<std::size_t>(chain.size())),
      pivots_(springs_.size()),
      forward_(springs_.size()),
      backward_(springs_.size()) {}

ChainSolver::Block ChainSolver::product(const Block& a, const Block& b) {
  return {a.xx * b.xx + a.xy * b.yx, a.xx * b.xy + a.xy * b.yy, a.yx * b.xx + a.yy * b.yx,
          a.yx * b.xy + a.yy * b.yy};
}

ChainSolver::Block ChainSolver::inverse(const Block& a) {
  const double scale = 1.0 / (a.xx * a.yy - a.xy * a.yx);
  return {a.yy * scale, -a.xy * scale, -a.yx * scale, a.xx * scale};
}

ChainSolver::Block ChainSolver::diagonal(Eigen::Index particle) const {
  const auto i = static_cast<std::size_t>(particle);
  const Block &left = springs_[i - 1], &right = springs_[i];
  const double mass = masses_[particle];
  return {mass + (left.xx + right.xx), left.xy + right.xy, left.yx + right.yx,
          mass + (left.yy + right.yy)};
}

void ChainSolver::eliminate(Eigen::Index from, const Block& spring, Block& neighbour,
                            Block& forward) {
  const auto i = static_cast<std::size_t>(from);
  backward_[i] = product(pivots_[i], spring);
  forward = product(spring, pivots_[i]);
  const Block fill = product(spring, backward_[i]);
  neighbour.xx -= fill.xx;
  neighbour.xy -= fill.xy;
  neighbour.yx -= fill.yx;
  neighbour.yy -= fill.yy;
}

void ChainSolver::factor(const SpringJacobian& jacobian, double q) {
  const Eigen::Index size = masses_.size();
  if (size < 2) return;
  const double q2 = q * q;
  for (Eigen::Index i = 0; i + 1 < size; ++i) {
    const auto entry = [&](int c) {
      return q * jacobian.damping(i, c) + q2 * jacobian.stiffness(i, c);
    };
    springs_[static_cast<std::size_t>(i)] = {entry(0), entry(1), entry(2), entry(3)};
  }
  const auto at = [](std::vector<Block>& blocks, Eigen::Index i) -> Block& {
    return blocks[static_cast<std::size_t>(i)];
  };
  Eigen::Index left = 1, right = size - 1;
  Block left_pivot = diagonal(left), right_pivot = diagonal(right);
  for (; right - left > 1; ++left, --right) {
    at(pivots_, left) = inverse(left_pivot);
    at(pivots_, right) = inverse(right_pivot);
    left_pivot = diagonal(left + 1);
    eliminate(left, at(springs_, left), left_pivot, at(forward_, left + 1));
    if (left + 1 == right - 1) {
      eliminate(right, at(springs_, right - 1), left_pivot, forward_middle_);
    } else {
      right_pivot = diagonal(right - 1);
      eliminate(right, at(springs_, right - 1), right_pivot, at(forward_, right - 1));
    }
  }
  if (right > left) {  // an even number of moving particles: the right one goes before the left
    at(pivots_, right) = inverse(right_pivot);
    eliminate(right, at(springs_, left), left_pivot, forward_middle_);
  }
  at(pivots_, left) = inverse(left_pivot);
}

// The last result of each recursion is carried along in registers: reading it back from memory
// would lengthen the chain of dependent operations, which is what the time goes into.
void ChainSolver::solve(double* x, double* y) const {
  const auto size = static_cast<std::ptrdiff_t>(masses_.size());
  if (size < 2) return;
  using Vector = PlaneVector<double>;
  const auto add = [x, y](std::ptrdiff_t i, const Block& a, const Vector& v) {
    const Vector sum{x[i] + (a.xx * v.x + a.xy * v.y), y[i] + (a.yx * v.x + a.yy * v.y)};
    x[i] = sum.x;
    y[i] = sum.y;
    return sum;
  };
  const std::ptrdiff_t middle = middle_;
  Vector from_left{x[1], y[1]}, from_right{x[size - 1], y[size - 1]};
  for (std::ptrdiff_t left = 2, right = size - 2; right > middle; ++left, --right) {
    from_right = add(right, forward_[static_cast<std::size_t>(right)], from_right);
    if (left < middle) from_left = add(left, forward_[static_cast<std::size_t>(left)], from_left);
  }
  if (middle > 1) add(middle, forward_[static_cast<std::size_t>(middle)], from_left);
  if (middle + 1 < size) add(middle, forward_middle_, from_right);
  for (std::ptrdiff_t i = 1; i < size; ++i) {
    const Block& pivot = pivots_[static_cast<std::size_t>(i)];
    const Vector v{pivot.xx * x[i] + pivot.xy * y[i], pivot.yx * x[i] + pivot.yy * y[i]};
    x[i] = v.x;
    y[i] = v.y;
  }
  from_left = from_right = {x[middle], y[middle]};
  for (std::ptrdiff_t left = middle - 1, right = middle + 1; right < size; --left, ++right) {
    from_right = add(right, backward_[static_cast<std::size_t>(right)], from_right);
    if (left > 0) from_left = add(left, backward_[static_cast<std::size_t>(left)], from_left);
  }
}

}  // namespace spring_pendulum
