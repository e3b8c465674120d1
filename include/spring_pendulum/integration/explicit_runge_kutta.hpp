// The engine that runs every explicit Runge-Kutta tableau with a fixed step.
#pragma once

#include <spring_pendulum/integration/butcher_tableau.hpp>
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <vector>

namespace spring_pendulum {

class ExplicitRungeKutta : public Integrator {
 public:
  ExplicitRungeKutta(Chain chain, const ButcherTableau& tableau, bool track_dissipation);

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
