// The two simplest symplectic methods. Without damping their maps preserve phase space volume
// exactly, so the energy error stays bounded over any number of steps instead of drifting.
//
//     Semi-Implicit-Euler     v' = v + h a(p, v)           p' = p + h v'
//
//     Velocity-Verlet         u  = v + h/2 a(p, v)         p' = p + h u
//                             v' = u + h/2 a(p', v + h a(p, v))
//
// With damping, the force depends on the velocities, and using the new velocities would make the
// methods implicit. Semi-Implicit-Euler uses the old velocities and keeps order 1. Velocity-Verlet
// uses velocities predicted by an Euler step, keeps order 2, and evaluates the forces twice instead
// of once per step. Neither method is then symplectic or reversible; nor is the damped motion.
//
// Both are stable for undamped oscillation of angular frequency ω if h ω < 2, and for pure damping
// of rate γ if h γ < 2.
//
// References: L. Verlet, Phys. Rev. 159 (1967) 98-103, doi:10.1103/PhysRev.159.98; W. C. Swope,
// H. C. Andersen, P. H. Berens, K. R. Wilson, J. Chem. Phys. 76 (1982) 637-649,
// doi:10.1063/1.442716; E. Hairer, C. Lubich, G. Wanner, Acta Numer. 12 (2003) 399-450,
// doi:10.1017/S0962492902000144.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/dissipated_energy.hpp"
#include "integration/kernels/held_work.hpp"
#include "integration/kernels/kernel_constants.hpp"
#include "integration/kernels/state_buffer.hpp"
#include "integration/work.hpp"
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <cstdint>

namespace spring_pendulum {

/// Base class with workspace, counters, and the dissipated and supplied energies, which are integrated
/// with the trapezoidal rule over each step.
class SymplecticMethod : public SpringwiseIntegrator {
 public:
  void advance(State& state, double time_step, std::int64_t steps) final;
  double work() const final {
    return kFixedStepTime.of(chain_.size()) * static_cast<double>(force_evaluations_);
  }
  std::int64_t forceEvaluations() const final { return force_evaluations_; }
  double suppliedEnergy() const final { return held_work_.total(); }
  void restart() final;

 protected:
  SymplecticMethod(const Chain& chain, bool track_dissipation);

  /// Advances `current()` by one step.
  virtual void step(double time_step) = 0;
  /// Discards what was kept from the last step, because the next step starts from another state.
  virtual void forget() {}

  bool damped() const { return chain_.isDissipative(); }
  StateBuffer& current() { return current_; }
  /// Writes the accelerations of a state to the columns vx and vy of `slope`.
  void evaluate(const StateBuffer& state, StateBuffer& slope);
  /// state velocities += weight * slope accelerations
  void kick(StateBuffer& state, double weight, const StateBuffer& slope) const;
  /// positions += weight * velocities
  void drift(StateBuffer& state, double weight) const;

 private:
  /// Adds the current powers, dissipated and supplied, times `time` s.
  void addPowers(double time);
  /// The part of `addPowers` that most chains do not need.
  void addWorkAndDrag(double time);

  Chain chain_;
  bool track_dissipation_;
  KernelConstants constants_;
  const ChainKernels& kernels_;
  StateBuffer current_;
  HeldWork held_work_;
  std::int64_t force_evaluations_ = 0;
};

/// Order 1. R. de Vogelaere 1956 (unpublished); Hairer, Lubich, Wanner, section 1.3.
class SemiImplicitEuler final : public SymplecticMethod {
 public:
  SemiImplicitEuler(const Chain& chain, bool track_dissipation);

 private:
  void step(double time_step) override;

  StateBuffer slope_;
};

/// Order 2. One evaluation per step without damping, because the accelerations at the end of a step
/// are also those at the beginning of the next.
class VelocityVerlet final : public SymplecticMethod {
 public:
  VelocityVerlet(const Chain& chain, bool track_dissipation);

 private:
  void step(double time_step) override;
  void forget() override { begin_slope_known_ = false; }

  StateBuffer begin_slope_;
  StateBuffer end_slope_;
  StateBuffer predicted_;
  bool begin_slope_known_ = false;
};

}  // namespace spring_pendulum
