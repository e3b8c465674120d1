// What the kernels need to know of a chain, made once.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/state_buffer.hpp"
#include <spring_pendulum/model/chain.hpp>

namespace spring_pendulum {

/// A chain's constants as the kernels read them.
class KernelConstants {
 public:
  /// \param skip_masses whether equal masses are to be read once instead of for every particle
  explicit KernelConstants(const Chain& chain, bool skip_masses = true);

  /// Of the particles begin <= i < end as a chain of its own, in columns `pitch` apart; `begin` is
  /// a multiple of 8.
  KernelChain piece(Eigen::Index begin, Eigen::Index end, Eigen::Index pitch) const;

  const KernelChain& chain() const { return chain_; }

 private:
  AlignedNumbers inverse_masses_;
  KernelChain chain_;
};

}  // namespace spring_pendulum
