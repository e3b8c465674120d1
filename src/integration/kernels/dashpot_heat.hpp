// What the dashpots of a chain have dissipated, each for itself: a sum over time alone depends on no
// block, thread or instruction set.
#pragma once

#include "integration/kernels/state_buffer.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace spring_pendulum {

/// Heat of each spring, J, in a column as the kernels use it.
class DashpotHeat {
 public:
  DashpotHeat() = default;
  explicit DashpotHeat(Eigen::Index particles)
      : springs_(particles - 1), numbers_(StateBuffer::paddedSize(particles)) {}

  double* data() { return numbers_.data(); }
  void reset() { std::fill_n(numbers_.data(), springs_, 0.0); }

  /// J, of all springs, always summed in the same order.
  double total() const {
    std::array<double, 8> sums{};
    for (Eigen::Index i = 0; i < springs_; ++i) {
      sums[static_cast<std::size_t>(i % 8)] += numbers_.data()[i];
    }
    return ((sums[0] + sums[4]) + (sums[1] + sums[5])) +
           ((sums[2] + sums[6]) + (sums[3] + sums[7]));
  }

 private:
  Eigen::Index springs_ = 0;
  AlignedNumbers numbers_;
};

}  // namespace spring_pendulum
