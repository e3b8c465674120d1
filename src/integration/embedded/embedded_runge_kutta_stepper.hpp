// Embedded Runge-Kutta pairs with step-size control.
//
// The error is controlled per step and in the maximum norm, so that particles at rest do not dilute
// the error of a moving one. The solution of higher order is continued (local extrapolation), which
// makes the global error proportional to the tolerance.
#pragma once

#include "integration/embedded/embedded_pair.hpp"
#include "integration/error_control/error_estimating_stepper.hpp"

#include <vector>

namespace spring_pendulum {

class EmbeddedRungeKuttaStepper final : public ErrorEstimatingStepper {
 public:
  /// \param pair not null, must outlive the stepper
  EmbeddedRungeKuttaStepper(const Chain& chain, const EmbeddedPair* pair, double tolerance,
                            const ChainKernels& kernels = fastestChainKernels());

 private:
  void prepare(bool restarted) override;
  double attempt(double h) override;
  const StateBuffer& stateInside(double fraction) const override;

  const EmbeddedPair& pair_;
  std::vector<StateBuffer> slopes_;
  mutable StateBuffer inside_;
};

}  // namespace spring_pendulum
