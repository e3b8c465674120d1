// Steps of an embedded Runge-Kutta pair whose length follows the estimated error.
//
// The error is controlled in the maximum norm: no particle's error is diluted by others that do
// nothing. It is that of a step, one power of h above the error of the motion a unit of time; as
// the method of higher order continues the motion, its error is then proportional to the tolerance.
#pragma once

#include "integration/embedded/embedded_pair.hpp"
#include "integration/error_control/error_estimating_stepper.hpp"

#include <array>
#include <vector>

namespace spring_pendulum {

class EmbeddedRungeKuttaStepper final : public ErrorEstimatingStepper {
 public:
  /// \param pair must outlive the stepper
  EmbeddedRungeKuttaStepper(const Chain& chain, const EmbeddedPair& pair, double tolerance,
                            const ChainKernels& kernels = fastestChainKernels());

  void interpolate(double fraction, State& state) const override;
  StepStatistics statistics() const override;

 private:
  /// h times some weights, with the slopes they weigh; weights of 0 are left out.
  class Sum;

  void prepare(bool restarted) override;
  double attempt(double h) override;
  double errorOf(const EmbeddedPair::Weights& weights, double h) const;
  void makeExtraSlopes() const;

  const EmbeddedPair& pair_;
  // The extra slopes are made when somebody asks for the state inside a step.
  mutable std::vector<StateBuffer> slopes_;
  mutable bool extra_slopes_known_ = false;
  mutable std::int64_t extra_evaluations_ = 0;
  mutable StateBuffer inside_;
};

}  // namespace spring_pendulum
