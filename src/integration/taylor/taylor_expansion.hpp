// The Taylor coefficients of a chain's motion: their memory, and the weights of plain sums of them.
#pragma once

#include "integration/kernels/state_buffer.hpp"
#include "integration/kernels/taylor_workspace.hpp"
#include <spring_pendulum/model/chain.hpp>

namespace spring_pendulum {

/// A workspace for the kernels with the memory it points to. `work().size` and `work().order` may
/// be made smaller and, up to what they were at first, larger again.
class TaylorExpansion {
 public:
  /// \param order K in 2..14, the most coefficients
  TaylorExpansion(const Chain& chain, int order);

  TaylorWorkspace& work() { return work_; }
  const TaylorWorkspace& work() const { return work_; }

 private:
  AlignedNumbers inverse_masses_;
  AlignedNumbers next_inverse_masses_;
  AlignedNumbers springs_;
  AlignedNumbers accelerations_;
  TaylorWorkspace work_;
};

/// The sum of the first `count` coefficients, `time` s later.
TaylorWeights taylorWeights(std::ptrdiff_t count, double time);

}  // namespace spring_pendulum
