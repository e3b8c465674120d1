// An explicit Runge-Kutta method with a fixed step, computed stage by stage as the formula is
// written, for any tableau. `ExplicitRungeKutta` gives the same bits in less time for the tableaus
// that have a kernel; the method table chooses between them.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/dissipated_energy.hpp"
#include "integration/kernels/held_work.hpp"
#include "integration/kernels/kernel_constants.hpp"
#include "integration/kernels/state_buffer.hpp"
#include "integration/work.hpp"
#include <spring_pendulum/integration/butcher_tableau.hpp>
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <vector>

namespace spring_pendulum {

/// `advance` sets the velocity of the first particle, which is fixed, to 0.
class PlainRungeKutta : public SpringwiseIntegrator {
 public:
  PlainRungeKutta(const Chain& chain, const ButcherTableau& tableau, bool track_dissipation,
                  const ChainKernels& kernels = fastestChainKernels());

  void advance(State& state, double time_step, std::int64_t steps) override;
  double work() const override {
    return kFixedStepTime.of(constants_.chain().size) * static_cast<double>(force_evaluations_);
  }
  std::int64_t forceEvaluations() const override { return force_evaluations_; }
  double suppliedEnergy() const override { return held_work_.total(); }
  void restart() override {
    dissipated_.reset();
    held_work_.reset();
  }

 private:
  void step(double time_step);

  ButcherTableau tableau_;
  bool track_dissipation_;
  double damping_;   ///< N·s/m
  double air_drag_;  ///< N·s/m
  KernelConstants constants_;
  const ChainKernels& kernels_;
  HeldWork held_work_;
  StateBuffer state_;
  StateBuffer stage_;                ///< z_n + h sum a_ij k_j
  std::vector<StateBuffer> slopes_;  ///< k_i, one per stage
  std::int64_t force_evaluations_ = 0;
};

}  // namespace spring_pendulum
