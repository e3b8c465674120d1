// What the kernels need to know of a chain, made once.
#pragma once

#include <spring_pendulum/integration/chain_kernels.hpp>
#include <spring_pendulum/integration/state_buffer.hpp>
#include <spring_pendulum/model/chain.hpp>

namespace spring_pendulum {

/// A chain's constants as the kernels read them.
class KernelConstants {
 public:
  explicit KernelConstants(const Chain& chain);

  const KernelChain& chain() const { return chain_; }

 private:
  AlignedNumbers inverse_masses_;
  KernelChain chain_;
};

}  // namespace spring_pendulum
