// Two methods of our own: Ralston's from its tableau, and Heun's as a class.
#pragma once

#include <spring_pendulum/spring_pendulum.hpp>

#include <cstdint>
#include <memory>

/// Ralston's method, order 2. A. Ralston, Math. Comp. 16 (1962) 431-437.
inline constexpr spring_pendulum::ButcherTableau kRalstonTableau{
    2, {{{}, {2.0 / 3.0}}}, {1.0 / 4.0, 3.0 / 4.0}};

/// Heun's method: the trapezoidal rule with a predicted end, order 2.
class Heun : public spring_pendulum::Integrator {
 public:
  explicit Heun(const spring_pendulum::Chain& chain) : chain_(chain), stage_(chain.size()) {}

  void integrate(spring_pendulum::State& state, double time_step, std::int64_t steps) override {
    for (std::int64_t n = 0; n < steps; ++n) {
      computeSlope(chain_, state, begin_slope_);
      stage_.values() = state.values() + time_step * begin_slope_.values();
      computeSlope(chain_, stage_, end_slope_);
      const double power = dissipatedPower(chain_, state) + dissipatedPower(chain_, stage_);
      dissipated_energy_ += 0.5 * time_step * power;
      state.values() += 0.5 * time_step * (begin_slope_.values() + end_slope_.values());
      force_evaluations_ += 2;
    }
  }
  double work() const override {
    return 1e-8 * static_cast<double>(force_evaluations_ * chain_.size());
  }
  std::int64_t forceEvaluations() const override { return force_evaluations_; }
  double dissipatedEnergy() const override { return dissipated_energy_; }
  void restart() override { dissipated_energy_ = 0.0; }

 private:
  spring_pendulum::Chain chain_;
  spring_pendulum::State stage_, begin_slope_, end_slope_;
  std::int64_t force_evaluations_ = 0;
  double dissipated_energy_ = 0.0;
};

inline void registerOwnMethods() {
  using namespace spring_pendulum;
  Method ralston{"Ralston", 2, 2, StepControl::kFixed};
  ralston.real_stability_limit = 2.0;
  ralston.reference = "A. Ralston, Math. Comp. 16 (1962) 431-437";
  ralston.use = "of all two-stage methods of order 2 the one with the smallest error bound";
  ralston.tableau = &kRalstonTableau;
  registerMethod(ralston);

  Method heun{"Heun", 2, 2, StepControl::kFixed};
  heun.real_stability_limit = 2.0;
  heun.reference = "K. Heun, Z. Math. Phys. 45 (1900) 23-38";
  heun.use = "an exercise: the trapezoidal rule with a predicted end";
  heun.make = [](const Method&, const Chain& chain, const IntegratorOptions&) {
    return std::make_unique<Heun>(chain);
  };
  registerMethod(heun);
}
