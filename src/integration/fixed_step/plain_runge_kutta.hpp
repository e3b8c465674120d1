// An explicit Runge-Kutta method with a fixed step, step by step and stage by stage as the formula
// is written. It runs any tableau. `ExplicitRungeKutta` gives the same bits faster where its kernels
// know the tableau.
#pragma once

#include "integration/kernels/dashpot_heat.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/kernel_constants.hpp"
#include "integration/kernels/state_buffer.hpp"
#include <spring_pendulum/integration/butcher_tableau.hpp>
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <vector>

namespace spring_pendulum {

/// As `Integrator`. The velocity of the first particle, which is fixed, is set to 0.
class PlainRungeKutta : public Integrator {
 public:
  PlainRungeKutta(const Chain& chain, const ButcherTableau& tableau, bool track_dissipation,
                  const ChainKernels& kernels = fastestChainKernels());

  void advance(State& state, double time_step, std::int64_t steps) override;
  std::int64_t forceEvaluations() const override { return force_evaluations_; }
  double dissipatedEnergy() const override { return heat_.total(); }
  void restart() override { heat_.reset(); }

 private:
  void step(double time_step);
  /// sum_j h w_j k_j over the first `stages` slopes, without those of weight 0.
  SlopeSum sum(double time_step, const std::array<double, ButcherTableau::kMaxStages>& weights,
               std::size_t stages);

  ButcherTableau tableau_;
  bool track_dissipation_;
  double damping_;  ///< N·s/m
  KernelConstants constants_;
  const ChainKernels& kernels_;
  DashpotHeat heat_;
  StateBuffer state_;
  StateBuffer stage_;                ///< z_n + h sum a_ij k_j
  std::vector<StateBuffer> slopes_;  ///< k_i, one a stage
  std::vector<WeightedSlope> terms_;
  std::int64_t force_evaluations_ = 0;
};

}  // namespace spring_pendulum
