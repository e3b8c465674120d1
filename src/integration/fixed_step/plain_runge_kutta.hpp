// An explicit Runge-Kutta method with a fixed step, step by step and stage by stage as the formula
// is written. `ExplicitRungeKutta` gives the same bits much faster; this is what it is compared
// with, and what runs where the heat of the dashpots is integrated along.
#pragma once

#include <spring_pendulum/integration/butcher_tableau.hpp>
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <vector>

namespace spring_pendulum {

/// As `Integrator`. The velocity of the first particle, which is fixed, is set to 0.
class PlainRungeKutta : public Integrator {
 public:
  PlainRungeKutta(Chain chain, const ButcherTableau& tableau, bool track_dissipation);

  void advance(State& state, double time_step, std::int64_t steps) override;
  std::int64_t forceEvaluations() const override { return force_evaluations_; }
  double dissipatedEnergy() const override { return dissipated_energy_; }
  void restart() override { dissipated_energy_ = 0.0; }

 private:
  void step(State& state, double time_step);

  Chain chain_;
  ButcherTableau tableau_;
  bool track_dissipation_;
  double dissipated_energy_ = 0.0;
  State stage_;                ///< z_n + h sum a_ij k_j
  std::vector<State> slopes_;  ///< k_i, one a stage
  PlaneVectors accelerations_;
  std::int64_t force_evaluations_ = 0;
};

}  // namespace spring_pendulum
