// States and slopes in the layout of the vector kernels.
#pragma once

#include <spring_pendulum/model/aligned_numbers.hpp>
#include <spring_pendulum/model/state.hpp>

#include <Eigen/Core>

namespace spring_pendulum {

/// N rows with the columns x, y, vx, vy (or their derivatives), like `State`. Every column begins
/// on a cache line and is padded with zeros to `pitch()` rows, so that kernels may read and write
/// whole vectors. Column c of particle i is `data()[c * pitch() + i]`.
class StateBuffer {
 public:
  StateBuffer() = default;
  explicit StateBuffer(Eigen::Index particles)
      : size_(particles), pitch_(paddedSize(particles)), numbers_(4 * pitch_) {}

  /// Returns `particles` rounded up to a multiple of the longest vector, 8 doubles.
  static Eigen::Index paddedSize(Eigen::Index particles) { return (particles + 7) / 8 * 8; }

  Eigen::Index size() const { return size_; }
  Eigen::Index pitch() const { return pitch_; }
  double* data() { return numbers_.data(); }
  const double* data() const { return numbers_.data(); }

  /// The N×4 matrix without the padding.
  auto values() { return Map(data(), size_, 4, Eigen::OuterStride<>(pitch_)); }
  auto values() const { return ConstMap(data(), size_, 4, Eigen::OuterStride<>(pitch_)); }

 private:
  using Map = Eigen::Map<State::Matrix, Eigen::Unaligned, Eigen::OuterStride<>>;
  using ConstMap = Eigen::Map<const State::Matrix, Eigen::Unaligned, Eigen::OuterStride<>>;

  Eigen::Index size_ = 0;
  Eigen::Index pitch_ = 0;
  AlignedNumbers numbers_;
};

}  // namespace spring_pendulum
