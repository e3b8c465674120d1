// The constants of a chain in the layout of the kernels.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/state_buffer.hpp"
#include <spring_pendulum/model/chain.hpp>

namespace spring_pendulum {

/// Owns the memory to which a `KernelChain` points.
class KernelConstants {
 public:
  explicit KernelConstants(const Chain& chain);

  /// Returns the particles begin <= i < end as a chain of its own, with columns `pitch` apart.
  /// \param begin a multiple of 8
  KernelChain piece(Eigen::Index begin, Eigen::Index end, Eigen::Index pitch) const;

  const KernelChain& chain() const { return chain_; }

 private:
  AlignedNumbers inverse_masses_;
  AlignedNumbers drive_;
  AlignedNumbers drag_rates_;
  KernelChain chain_;
};

}  // namespace spring_pendulum
