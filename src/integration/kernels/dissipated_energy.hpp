// The energy dissipated by each dashpot. Each spring has its own sum over time, so the result does
// not depend on blocks, threads or instruction sets.
#pragma once

#include "integration/kernels/state_buffer.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace spring_pendulum {

/// Dissipated energy of each spring, J, as an aligned column for the kernels.
class DissipatedEnergy {
 public:
  DissipatedEnergy() = default;
  explicit DissipatedEnergy(Eigen::Index particles)
      : springs_(particles - 1), numbers_(StateBuffer::pitchFor(particles)) {}

  double* data() { return numbers_.data(); }
  void reset() { std::fill_n(numbers_.data(), springs_, 0.0); }

  /// Sum over all springs, J, always in the same order.
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
