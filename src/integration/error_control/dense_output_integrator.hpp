// The integrator of every error-controlled method. Its stepper chooses the step sizes and runs
// ahead of the output times. States at output times and the dissipated energy come from the dense
// output. No step is shortened to hit an output time, so the sampling rate changes neither the
// steps nor the bits of states at common output times.
//
// Reference: E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd
// ed., Springer 1993, section II.6 (dense output).
#pragma once

#include "integration/error_control/dense_output_stepper.hpp"
#include "integration/kernels/energy_flow.hpp"
#include "integration/kernels/held_motion.hpp"
#include "integration/kernels/kernel_data.hpp"
#include "integration/work.hpp"
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <algorithm>
#include <memory>

namespace spring_pendulum {

class DenseOutputIntegrator final : public Integrator {
 public:
  /// \param stepper of the chain
  DenseOutputIntegrator(const Chain& chain, std::unique_ptr<DenseOutputStepper> stepper,
                        bool track_dissipation = false);
  double work() const override {
    return kTaylorTime.of(constants_.chain().size) * stepper_->workPerEvaluation() *
           static_cast<double>(forceEvaluations());
  }
  std::int64_t forceEvaluations() const override { return statistics().force_evaluations; }
  double dissipatedEnergy() const override { return before_step_.dissipated + in_step_.dissipated; }
  double suppliedEnergy() const override { return before_step_.supplied + in_step_.supplied; }
  void restart() override;
  std::string report() const override { return stepper_->report(); }

  StepStatistics statistics() const { return stepper_->statistics(); }

 private:
  /// The n-th output time after a (re)start is n * time_step with an integer n, so sampling twice
  /// as often with half the time_step gives the same bits at the common times. If time_step differs
  /// from the last call, n counts from the last output time. Only the first call after a (re)start
  /// reads `state`.
  /// If the motion diverges, `state` is NaN, except for the first particle, at all output times
  /// that the steps did not reach.
  void integrate(State& state, double time_step, std::int64_t steps) override;

  /// \returns 0 or `steps`
  std::int64_t integrateWithin(State& state, double time_step, std::int64_t steps,
                               double most_work) override;
  void takeStep();
  struct Energies {
    double dissipated = 0.0;  ///< J
    double supplied = 0.0;    ///< J
  };
  /// Returns the energies of the first `fraction` of the last step.
  Energies energiesOf(double fraction);

  std::unique_ptr<DenseOutputStepper> stepper_;
  KernelConstants constants_;
  const ChainKernels& kernels_;
  HeldMotion held_;
  EnergyFlow energy_flow_;  ///< of a part of the last step
  bool started_ = false;
  bool diverged_ = false;
  int shortest_steps_ = 0;          ///< number of consecutive shortest steps, up to now
  double output_origin_ = 0.0;      ///< s since the start; outputs are n * output_step_ later
  double output_step_ = 0.0;        ///< time_step of the last call
  std::int64_t outputs_ = 0;        ///< n
  double step_begin_ = 0.0;         ///< s since the start
  double step_length_ = 0.0;        ///< s
  double step_end_ = 0.0;           ///< s since the start
  double lost_time_ = 0.0;          ///< s that rounding has cut from `step_end_`
  Energies before_step_, in_step_;  ///< the latter up to the last output time
};

}  // namespace spring_pendulum
