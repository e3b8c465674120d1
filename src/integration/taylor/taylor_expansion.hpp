// Memory for the Taylor coefficients of a chain's motion, and the weights of the plain series.
#pragma once

#include "integration/kernels/state_buffer.hpp"
#include "integration/kernels/taylor_workspace.hpp"
#include <spring_pendulum/model/chain.hpp>

namespace spring_pendulum {

/// Owns the memory to which a `TaylorWorkspace` points. `work().size` and `work().order` may be set
/// to smaller values, and back up to their initial values.
class TaylorExpansion {
 public:
  /// \param order K in 2..14, the largest number of coefficients
  TaylorExpansion(const Chain& chain, int order);

  TaylorWorkspace& work() { return work_; }
  const TaylorWorkspace& work() const { return work_; }

 private:
  AlignedNumbers inverse_masses_;
  AlignedNumbers left_inverse_masses_;
  AlignedNumbers springs_;
  AlignedNumbers accelerations_;
  TaylorWorkspace work_;
};

/// Returns the weights that sum the first `count` coefficients of the series at `time` s.
TaylorWeights taylorWeights(std::ptrdiff_t count, double time);

}  // namespace spring_pendulum
