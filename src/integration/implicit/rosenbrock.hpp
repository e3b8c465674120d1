// Error-controlled Rosenbrock methods: implicit enough that no damping limits the step, and linear
// enough that a step needs one factorisation and one solve a stage, no iteration.
//
// Take it for chains with very light particles (their dashpots make rates of k_d/m) as long as the
// light particles' own sideways vibration need not be resolved; where it must be, or where nothing
// is stiff, an explicit method does a step for much less.
#pragma once

#include "integration/error_control/error_estimating_stepper.hpp"
#include "integration/implicit/chain_solver.hpp"
#include "integration/implicit/rosenbrock_tableau.hpp"
#include "model/jacobian.hpp"
#include <spring_pendulum/model/dynamics.hpp>

#include <vector>

namespace spring_pendulum {

class RosenbrockStepper final : public ErrorEstimatingStepper {
 public:
  RosenbrockStepper(const Chain& chain, const RosenbrockTableau& tableau, double tolerance,
                    const ChainKernels& kernels = fastestChainKernels());

  void interpolate(double fraction, State& state) const override;

 private:
  void prepare(bool) override { jacobian_is_current_ = false; }
  double attempt(double h) override;
  void computeStage(std::size_t i, double h);
  /// (I/q - J) u = right-hand side, in place.
  void solveStage(StateBuffer& u, double q);

  const RosenbrockTableau& tableau_;
  SpringJacobian jacobian_;
  bool jacobian_is_current_ = false;
  ChainSolver solver_;
  StateBuffer slope_;
  std::vector<StateBuffer> increments_;  ///< u_i, one a stage
  State::PlaneMatrix momenta_;           ///< right-hand side of the eliminated system
};

}  // namespace spring_pendulum
