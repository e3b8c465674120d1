// What all methods with a fixed step have in common.
#pragma once

#include "base/checks.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/energy_flow.hpp"
#include "integration/kernels/held_motion.hpp"
#include "integration/kernels/kernel_data.hpp"
#include "integration/work.hpp"
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <cstdint>

namespace spring_pendulum {

/// Counts evaluations, and sums the dissipated energy of each spring.
class FixedStepIntegrator : public Integrator {
 public:
  double work() const override {
    return kFixedStepTime.of(chain().size) * static_cast<double>(force_evaluations_);
  }
  std::int64_t forceEvaluations() const final { return force_evaluations_; }
  double dissipatedEnergy() const final { return energy_flow_.dissipated(); }
  double suppliedEnergy() const final { return energy_flow_.supplied(); }
  void restart() override {
    energy_flow_.reset();
    held_.restart();
  }

 protected:
  FixedStepIntegrator(const Chain& chain, bool track_dissipation, const ChainKernels& kernels)
      : constants_(chain),
        kernels_(kernels),
        held_(chain),
        energy_flow_(chain, track_dissipation) {}

  const KernelChain& chain() const { return constants_.chain(); }
  /// Computes F of a state.
  void evaluate(const StateBuffer& state, StateBuffer& slope) {
    kernels_.stageSlope(chain(), state.data(), kNoSlopes, slope.data());
    ++force_evaluations_;
  }
  /// Adds the powers at a state, dissipated and supplied, times `time` s.
  void addPowers(const StateBuffer& state, double time) {
    energy_flow_.add(kernels_, chain(), state, time, time * chain().spring.damping);
  }

  /// Corrects the work of a step for which the power at one of its ends was taken. Of a kick of n steps,
  /// a share of 1/n would be missing.
  void trapezoidalRule(const StateBuffer& taken, const StateBuffer& other, double time_step) {
    energy_flow_.addSupplied(taken, -0.5 * time_step);
    energy_flow_.addSupplied(other, 0.5 * time_step);
  }

  const KernelConstants constants_;
  const ChainKernels& kernels_;
  HeldMotion held_;
  EnergyFlow energy_flow_;
  std::int64_t force_evaluations_ = 0;
};

/// A method that is written as one step of `current()`.
class SteppedIntegrator : public FixedStepIntegrator {
 protected:
  SteppedIntegrator(const Chain& chain, bool track_dissipation,
                    const ChainKernels& kernels = fastestChainKernels())
      : FixedStepIntegrator(chain, track_dissipation, kernels), current_(chain.size()) {}

  /// Puts held particles in their places, too, before it takes the power of their holders there.
  virtual void step(double time_step) = 0;
  StateBuffer& current() { return current_; }
  /// state velocities += weight * slope accelerations
  void kick(StateBuffer& state, double weight, const StateBuffer& slope) const {
    const Eigen::Index velocities = 2 * state.pitch();
    kernels_.addWeighted(velocities, weight, slope.data() + velocities, state.data() + velocities);
  }
  /// positions += weight * velocities
  void drift(StateBuffer& state, double weight) const {
    const Eigen::Index positions = 2 * state.pitch();
    kernels_.addWeighted(positions, weight, state.data() + positions, state.data());
  }

 private:
  void integrate(State& state, double time_step, std::int64_t steps) final {
    requireAdvance(chain().size, state.size(), time_step, steps);
    held_.begin(state, time_step);
    current_.values() = state.values();
    for (std::int64_t n = 0; n < steps; ++n) step(time_step);
    state.values() = current_.values();
  }

  StateBuffer current_;
};

}  // namespace spring_pendulum
