// States, slopes and chains in the layout of the vector kernels.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include <spring_pendulum/base/aligned_numbers.hpp>
#include <spring_pendulum/integration/butcher_tableau.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace spring_pendulum {

/// N rows with the columns x, y, vx, vy (or their derivatives), like `State`. In every column the
/// first moving particle begins a cache line and zeros surround the N rows, so that kernels may read
/// and write whole vectors. Column c of particle i is `particle(i)[c * pitch()]`.
class StateBuffer {
 public:
  StateBuffer() = default;
  explicit StateBuffer(Eigen::Index particles)
      : size_(particles), pitch_(pitchFor(particles)), numbers_(4 * pitch_) {}

  /// Returns `count` rounded up to a multiple of the longest vector, 8 doubles.
  static Eigen::Index paddedSize(Eigen::Index count) { return (count + 7) / 8 * 8; }
  /// Returns the length of a column: a vector that ends with the fixed particle, then vectors of
  /// moving particles, at least one.
  static Eigen::Index pitchFor(Eigen::Index particles) {
    return kFirstMoving + std::max<Eigen::Index>(paddedSize(particles - 1), 8);
  }

  Eigen::Index size() const { return size_; }
  Eigen::Index pitch() const { return pitch_; }
  void setZero() { std::fill_n(data(), 4 * pitch_, 0.0); }  ///< also padding, which may be NaN
  double* data() { return numbers_.data(); }
  const double* data() const { return numbers_.data(); }

  double* particle(Eigen::Index i) { return data() + kFirstMoving - 1 + i; }
  const double* particle(Eigen::Index i) const { return data() + kFirstMoving - 1 + i; }

  /// The N×4 matrix without the padding.
  auto values() { return Map(particle(0), size_, 4, Eigen::OuterStride<>(pitch_)); }
  auto values() const { return ConstMap(particle(0), size_, 4, Eigen::OuterStride<>(pitch_)); }

 private:
  using Map = Eigen::Map<State::Matrix, Eigen::Unaligned, Eigen::OuterStride<>>;
  using ConstMap = Eigen::Map<const State::Matrix, Eigen::Unaligned, Eigen::OuterStride<>>;

  Eigen::Index size_ = 0;
  Eigen::Index pitch_ = 0;
  AlignedNumbers numbers_;
};

/// Returns the sum of h * weight * slope over the slopes of all stages, without terms of weight 0.
inline SlopeSum stageSum(double h, const std::array<double, ButcherTableau::kMaxStages>& weights,
                         const std::vector<StateBuffer>& slopes) {
  SlopeSum sum;
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    if (weights[i] != 0.0) sum.terms[sum.count++] = {h * weights[i], slopes[i].data()};
  }
  return sum;
}

/// Owns the memory to which a `KernelChain` points.
class KernelConstants {
 public:
  explicit KernelConstants(const Chain& chain);

  const KernelChain& chain() const { return chain_; }

 private:
  AlignedNumbers inverse_masses_;
  AlignedNumbers drive_;
  AlignedNumbers drag_rates_;
  KernelChain chain_;
};

}  // namespace spring_pendulum
