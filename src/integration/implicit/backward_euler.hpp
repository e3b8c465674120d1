// The implicit Euler method: simple, and without a stability limit.
//
//     p' = p + h v'      v' = v + h a(p', v')
//
// With p' substituted, the velocities remain. Newton's method solves for them, beginning with those at
// the start of the step; its linear systems are those of chain_solver.hpp with q = h.
//
// The stability function 1/(1 - z) vanishes at infinity: fast modes are damped out within a step,
// whether they are damped in truth or not (L-stable). The energy falls, therefore: stable is not accurate.
//
// Reference: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer
// 1996, sections IV.3 and IV.8; D. Baraff, A. Witkin, SIGGRAPH 1998, 43-54, doi:10.1145/280814.280821.
#pragma once

#include "integration/fixed_step/fixed_step_integrator.hpp"
#include "integration/implicit/chain_solver.hpp"
#include "integration/implicit/linear_spring.hpp"

#include <string>
#include <vector>

namespace spring_pendulum {

/// The dissipated and supplied energies are integrated with the powers at the end of each step. Where
/// Newton's method does not converge, the state becomes NaN, except for the first particle.
class BackwardEuler final : public SteppedIntegrator {
 public:
  BackwardEuler(const Chain& chain, bool track_dissipation);

  double work() const override {
    return kBackwardEulerTime.of(chain().size) * static_cast<double>(forceEvaluations());
  }
  std::string report() const override {
    return failed_ ? "Newton's method did not converge: take a smaller step" : "";
  }
  void restart() override {
    SteppedIntegrator::restart();
    failed_ = false;
  }

 private:
  void step(double time_step) override;
  /// Solves for the free particles of `current()`.
  /// \returns whether Newton's method converged
  bool solve(double time_step);
  /// Computes the right-hand side of the linear system from the guess `current()`, and its springs.
  void linearise(double time_step);

  Chain chain_;
  ChainSolver<double> solver_;
  std::vector<LinearSpring> springs_;
  StateBuffer begin_, slope_;
  std::vector<double> x_, y_;
  bool failed_ = false;
};

}  // namespace spring_pendulum
