#include "integration/implicit/chain_solver.hpp"

namespace spring_pendulum {

template <typename Scalar>
ChainSolver<Scalar>::ChainSolver(const Chain& chain)
    : chain_(chain),
      pivots_(static_cast<std::size_t>(chain.size())),
      forward_(pivots_.size()),
      backward_(pivots_.size()) {}

template <typename Scalar>
typename ChainSolver<Scalar>::Block ChainSolver<Scalar>::product(const Block& a, const Block& b) {
  return {a.xx * b.xx + a.xy * b.yx, a.xx * b.xy + a.xy * b.yy, a.yx * b.xx + a.yy * b.yx,
          a.yx * b.xy + a.yy * b.yy};
}

template <typename Scalar>
typename ChainSolver<Scalar>::Block ChainSolver<Scalar>::inverse(const Block& a) {
  const Scalar scale = reciprocal(a.xx * a.yy - a.xy * a.yx);
  return {a.yy * scale, -a.xy * scale, -a.yx * scale, a.xx * scale};
}

template <typename Scalar>
typename ChainSolver<Scalar>::Block ChainSolver<Scalar>::springBlock(Eigen::Index i) const {
  if (i + 1 >= chain_.size()) return {};
  const LinearSpring& spring = (*springs_)[static_cast<std::size_t>(i)];
  const double damping = chain_.spring().damping;
  const auto row = [&](double r) {  // r times the row vector q k_d rᵀ + q² (a - e r)ᵀ
    const PlaneVector<double>& s = spring.r;
    return PlaneVector<Scalar>{r * (q_ * (damping * s.x + q_ * (spring.a.x - spring.e * s.x))),
                               r * (q_ * (damping * s.y + q_ * (spring.a.y - spring.e * s.y)))};
  };
  const PlaneVector<Scalar> x = row(spring.r.x), y = row(spring.r.y);
  const Scalar e = q_ * q_ * spring.e;
  return {x.x + e, x.y, y.x, y.y + e};
}

template <typename Scalar>
typename ChainSolver<Scalar>::Block ChainSolver<Scalar>::diagonal(Eigen::Index particle) const {
  const Block left = springBlock(particle - 1), right = springBlock(particle);
  Scalar mass = massOf(chain_, particle);
  if (!chain_.isHeld(particle)) mass = mass + chain_.airDrag() * q_;
  return {mass + (left.xx + right.xx), left.xy + right.xy, left.yx + right.yx,
          mass + (left.yy + right.yy)};
}

template <typename Scalar>
void ChainSolver<Scalar>::eliminate(Eigen::Index from, const Block& spring, Block& neighbour,
                                    Block& forward) {
  const auto i = static_cast<std::size_t>(from);
  backward_[i] = product(pivots_[i], spring);
  forward = product(spring, pivots_[i]);
  const Block fill = product(spring, backward_[i]);
  neighbour = {neighbour.xx - fill.xx, neighbour.xy - fill.xy, neighbour.yx - fill.yx,
               neighbour.yy - fill.yy};
}

template <typename Scalar>
void ChainSolver<Scalar>::factor(const std::vector<LinearSpring>& springs, Scalar q) {
  const Eigen::Index size = chain_.size();
  if (size < 2) return;
  springs_ = &springs;
  q_ = q;
  const auto at = [](std::vector<Block>& blocks, Eigen::Index i) -> Block& {
    return blocks[static_cast<std::size_t>(i)];
  };
  Eigen::Index left = 1, right = size - 1;
  Block left_pivot = diagonal(left), right_pivot = diagonal(right);
  for (; right - left > 1; ++left, --right) {
    at(pivots_, left) = inverse(left_pivot);
    at(pivots_, right) = inverse(right_pivot);
    left_pivot = diagonal(left + 1);
    eliminate(left, springBlock(left), left_pivot, at(forward_, left + 1));
    if (left + 1 == right - 1) {
      eliminate(right, springBlock(right - 1), left_pivot, forward_middle_);
    } else {
      right_pivot = diagonal(right - 1);
      eliminate(right, springBlock(right - 1), right_pivot, at(forward_, right - 1));
    }
  }
  if (right > left) {  // even number of moving particles: eliminate the right one first
    at(pivots_, right) = inverse(right_pivot);
    eliminate(right, springBlock(left), left_pivot, forward_middle_);
  }
  at(pivots_, left) = inverse(left_pivot);
}

// Each recursion keeps its last result in registers. Reloading it from memory would lengthen the
// chain of dependent operations, which determines the time.
template <typename Scalar>
void ChainSolver<Scalar>::solve(Scalar* x, Scalar* y) const {
  const std::ptrdiff_t size = chain_.size();
  if (size < 2) return;
  using Vector = PlaneVector<Scalar>;
  const auto add = [x, y](std::ptrdiff_t i, const Block& a, const Vector& v) {
    const Vector sum{x[i] + (a.xx * v.x + a.xy * v.y), y[i] + (a.yx * v.x + a.yy * v.y)};
    x[i] = sum.x;
    y[i] = sum.y;
    return sum;
  };
  const std::ptrdiff_t middle = size / 2;  // eliminated last
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

template class ChainSolver<double>;
template class ChainSolver<Complex>;

}  // namespace spring_pendulum
