// What all methods with a fixed step have in common.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/energy_flow.hpp"
#include "integration/kernels/kernel_constants.hpp"
#include "integration/kernels/state_buffer.hpp"
#include "integration/work.hpp"
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <cstdint>

namespace spring_pendulum {

/// Counts evaluations, and sums the dissipated energy of each spring. `advance` sets the velocity of
/// the first particle, which is fixed, to 0.
class FixedStepIntegrator : public Integrator {
 public:
  double work() const override {
    return kFixedStepTime.of(chain().size) * static_cast<double>(force_evaluations_);
  }
  std::int64_t forceEvaluations() const final { return force_evaluations_; }
  double dissipatedEnergy() const final { return energy_flow_.dissipated().total(); }
  double suppliedEnergy() const final { return energy_flow_.supplied(); }
  void restart() override { energy_flow_.reset(); }

  /// Empty if the energy is not tracked.
  DissipatedEnergy& dissipated() { return energy_flow_.dissipated(); }

 protected:
  FixedStepIntegrator(const Chain& chain, bool track_dissipation, const ChainKernels& kernels)
      : constants_(chain), kernels_(kernels), energy_flow_(chain, track_dissipation) {}

  const KernelConstants& constants() const { return constants_; }
  const KernelChain& chain() const { return constants_.chain(); }
  const ChainKernels& kernels() const { return kernels_; }

  void countEvaluations(std::int64_t count) { force_evaluations_ += count; }
  /// Computes F of a state.
  void evaluate(const StateBuffer& state, StateBuffer& slope) {
    kernels_.stageSlope(chain(), state.data(), {}, slope.data());
    ++force_evaluations_;
  }
  /// Adds the powers at a state, dissipated and supplied, times `time` s.
  void addPowers(const StateBuffer& state, double time) {
    energy_flow_.add(kernels_, chain(), state, time, time * chain().spring.damping);
  }

 private:
  KernelConstants constants_;
  const ChainKernels& kernels_;
  EnergyFlow energy_flow_;
  std::int64_t force_evaluations_ = 0;
};

}  // namespace spring_pendulum
