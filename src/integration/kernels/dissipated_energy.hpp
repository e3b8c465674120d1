// The energy dissipated by each dashpot, and that by the air. Each spring has its own sum over time, so
// the result does not depend on blocks, threads or instruction sets.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/state_buffer.hpp"
#include "model/block_sums.hpp"
#include <spring_pendulum/model/chain.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

namespace spring_pendulum {

/// Dissipated energy of each spring, J, as an aligned column for the kernels.
class DissipatedEnergy {
 public:
  DissipatedEnergy() = default;
  explicit DissipatedEnergy(const Chain& chain)
      : springs_(chain.size() - 1),
        first_spring_(chain.firstSpring()),
        air_drag_(chain.airDrag()),
        numbers_(StateBuffer::pitchFor(chain.size())) {}

  double* data() { return numbers_.data(); }
  void reset() {
    std::fill_n(numbers_.data(), springs_, 0.0);
    air_ = 0.0;
  }

  /// Adds what the air dissipates at the velocities of a state in `time` s.
  void addDrag(const KernelChain& chain, const StateBuffer& state, double time) {
    if (air_drag_ == 0.0) return;
    double sum = 0.0;
    for (Eigen::Index i = 0; i < springs_; ++i) {
      const double* velocity = state.particle(i + 1) + 2 * state.pitch();
      const double square =
          velocity[0] * velocity[0] + velocity[state.pitch()] * velocity[state.pitch()];
      if (chain.drag_rates[i] != 0.0) sum += square;  // not held
    }
    air_ += time * air_drag_ * sum;
  }

  /// Sum over the springs first <= i < last, J.
  double sum(Eigen::Index first, Eigen::Index last) const {
    std::array<double, 8> sums{};
    for (Eigen::Index i = first; i < last; ++i) {
      sums[static_cast<std::size_t>((i - first) % 8)] += numbers_.data()[i];
    }
    return ((sums[0] + sums[4]) + (sums[1] + sums[5])) +
           ((sums[2] + sums[6]) + (sums[3] + sums[7]));
  }

  /// Sum over all springs and the air, J, always in the same order.
  double total() const {
    double total = air_;
    const Eigen::Index block = sumBlockSize(springs_);
    for (Eigen::Index first = 0; first < springs_; first += block) {
      total += sum(std::max(first, first_spring_), std::min(springs_, first + block));
    }
    return total;
  }

 private:
  Eigen::Index springs_ = 0;
  Eigen::Index first_spring_ = 0;  ///< springs before do not count
  double air_drag_ = 0.0;          ///< N·s/m
  AlignedNumbers numbers_;
  double air_ = 0.0;  ///< J
};

}  // namespace spring_pendulum
