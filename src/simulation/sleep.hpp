// A chain that has come to rest need not be stepped.
#pragma once

#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <cstdint>
#include <memory>
#include <utility>

namespace spring_pendulum {

/// Whether no particle is faster than `tolerance` m/s, nor would be after `duration` s of the
/// acceleration it has. A particle that turns round is not at rest: it is accelerated.
bool isAtRest(const Chain& chain, const State& state, double duration, double tolerance);

/// Hands a state to another integrator, unless the chain is at rest for as long as it is to be
/// carried on: then it sleeps, and the state stays as it is. That changes the result, by less than
/// the tolerance allows, so it is only done for a tolerance above 0.
class SleepingIntegrator : public Integrator {
 public:
  /// \param tolerance m/s; 0: never sleeps
  SleepingIntegrator(std::unique_ptr<Integrator> integrator, const Chain& chain, double tolerance)
      : integrator_(std::move(integrator)), chain_(chain), tolerance_(tolerance) {}

  void advance(State& state, double time_step, std::int64_t steps) override;
  std::int64_t forceEvaluations() const override { return integrator_->forceEvaluations(); }
  double dissipatedEnergy() const override {
    return dissipated_before_ + integrator_->dissipatedEnergy();
  }
  Skips skips() const override { return integrator_->skips(); }
  std::string report() const override { return integrator_->report(); }
  void restart() override;

  /// How many calls of `advance` found the chain at rest.
  std::int64_t sleptCalls() const { return slept_calls_; }

 private:
  std::unique_ptr<Integrator> integrator_;
  Chain chain_;
  double tolerance_;
  bool asleep_ = false;
  double dissipated_before_ = 0.0;  ///< J, until the last sleep
  std::int64_t slept_calls_ = 0;
};

}  // namespace spring_pendulum
