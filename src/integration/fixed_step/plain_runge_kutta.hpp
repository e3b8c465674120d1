// An explicit Runge-Kutta method with a fixed step, computed stage by stage as the formula is
// written, for any tableau. `ExplicitRungeKutta` gives the same bits in less time for the tableaus
// that have a kernel; the method table chooses between them.
#pragma once

#include "integration/fixed_step/fixed_step_integrator.hpp"
#include <spring_pendulum/integration/butcher_tableau.hpp>

#include <vector>

namespace spring_pendulum {

class PlainRungeKutta final : public SteppedIntegrator {
 public:
  PlainRungeKutta(const Chain& chain, const ButcherTableau& tableau, bool track_dissipation,
                  const ChainKernels& kernels = fastestChainKernels());

 private:
  void step(double time_step) override;

  ButcherTableau tableau_;
  StateBuffer stage_;                ///< z_n + h sum a_ij k_j
  std::vector<StateBuffer> slopes_;  ///< k_i, one per stage
};

}  // namespace spring_pendulum
