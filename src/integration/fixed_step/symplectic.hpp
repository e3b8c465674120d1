// The two simplest symplectic methods. Without damping their maps preserve phase space volume
// exactly, so the energy error stays bounded over any number of steps instead of drifting.
//
//     Semi-Implicit-Euler     v' = v + h a(p, v)           p' = p + h v'
//
//     Velocity-Verlet         u  = v + h/2 a(p, v)         p' = p + h u
//                             v' = u + h/2 a(p', v + h a(p, v))
//
// What damping does to them: the dashpots' force depends on the velocities, and solving for the new
// velocity in it would be implicit. It is evaluated with the velocities known so far: the old ones
// (Semi-Implicit-Euler, which stays of order 1), or those that a step of Euler's method predicts
// (Velocity-Verlet, which stays of order 2). With damping neither is symplectic or reversible, as
// the motion itself is not, and Velocity-Verlet evaluates the forces twice a step, not once.
//
// Both are stable for the undamped oscillation of angular frequency ω if h ω < 2, and for pure
// damping of rate γ if h γ < 2.
//
// References: L. Verlet, Phys. Rev. 159 (1967) 98-103, doi:10.1103/PhysRev.159.98; W. C. Swope,
// H. C. Andersen, P. H. Berens, K. R. Wilson, J. Chem. Phys. 76 (1982) 637-649,
// doi:10.1063/1.442716; E. Hairer, C. Lubich, G. Wanner, Acta Numer. 12 (2003) 399-450,
// doi:10.1017/S0962492902000144.
#pragma once

#include "integration/kernels/dashpot_heat.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/kernel_constants.hpp"
#include "integration/kernels/state_buffer.hpp"
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <cstdint>

namespace spring_pendulum {

/// What both share: workspace, counters, and the heat as the mean power of the ends of a step.
class SymplecticMethod : public Integrator {
 public:
  void advance(State& state, double time_step, std::int64_t steps) final;
  std::int64_t forceEvaluations() const final { return force_evaluations_; }
  double dissipatedEnergy() const final { return heat_.total(); }
  void restart() final;

 protected:
  SymplecticMethod(const Chain& chain, bool track_dissipation);

  /// One step of `current()`.
  virtual void step(double time_step) = 0;
  /// Tells that `current()` holds another state than the last step made.
  virtual void forget() {}

  bool damped() const { return chain_.spring().damping != 0.0; }
  StateBuffer& current() { return current_; }
  /// Accelerations of a state into the columns vx and vy of `slope`.
  void evaluate(const StateBuffer& state, StateBuffer& slope);
  /// state velocities += weight * slope accelerations
  void kick(StateBuffer& state, double weight, const StateBuffer& slope);
  /// positions += weight * velocities
  void drift(StateBuffer& state, double weight);

 private:
  /// Adds the heat that the current power dissipates in `time` s.
  void addHeat(double time);

  Chain chain_;
  bool track_dissipation_;
  KernelConstants constants_;
  const ChainKernels& kernels_;
  StateBuffer current_;
  DashpotHeat heat_;
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

/// Order 2, and without damping one evaluation a step: the accelerations at its end are those at
/// the beginning of the next.
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
