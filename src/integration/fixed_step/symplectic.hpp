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
// The dissipated and supplied energies are integrated with the trapezoidal rule over each step.
//
// References: L. Verlet, Phys. Rev. 159 (1967) 98-103, doi:10.1103/PhysRev.159.98; W. C. Swope,
// H. C. Andersen, P. H. Berens, K. R. Wilson, J. Chem. Phys. 76 (1982) 637-649,
// doi:10.1063/1.442716; E. Hairer, C. Lubich, G. Wanner, Acta Numer. 12 (2003) 399-450,
// doi:10.1017/S0962492902000144.
#pragma once

#include "integration/fixed_step/fixed_step_integrator.hpp"

namespace spring_pendulum {

/// Order 1. R. de Vogelaere 1956 (unpublished); Hairer, Lubich, Wanner, section 1.3.
class SemiImplicitEuler final : public SteppedIntegrator {
 public:
  SemiImplicitEuler(const Chain& chain, bool track_dissipation);

 private:
  void step(double time_step) override;

  StateBuffer slope_;
};

/// Order 2. One evaluation per step without damping, because the accelerations at the end of a step
/// are also those at the beginning of the next.
class VelocityVerlet final : public SteppedIntegrator {
 public:
  VelocityVerlet(const Chain& chain, bool track_dissipation);

  void restart() override {
    SteppedIntegrator::restart();
    begin_slope_known_ = false;
  }

 private:
  void step(double time_step) override;

  bool damped_;
  StateBuffer begin_slope_;
  StateBuffer end_slope_;
  StateBuffer predicted_;
  bool begin_slope_known_ = false;
};

}  // namespace spring_pendulum
