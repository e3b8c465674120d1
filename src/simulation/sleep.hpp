// Skipping the steps of a chain at rest.
#pragma once

#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <cstdint>
#include <memory>
#include <utility>

namespace spring_pendulum {

/// Whether the speed of every particle is at most `tolerance` m/s, and its current acceleration
/// changes the velocity by at most this in `duration` s. The second condition excludes particles at
/// a turning point.
bool isAtRest(const Chain& chain, const State& state, double duration, double tolerance);

/// Calls another integrator unless the chain is at rest for the whole interval; then the chain
/// "sleeps" and its state does not change. This changes results within the tolerance, so it is off
/// by default.
class SleepingIntegrator : public Integrator {
 public:
  /// \param tolerance m/s; 0: off
  SleepingIntegrator(std::unique_ptr<Integrator> integrator, Chain chain, double tolerance)
      : integrator_(std::move(integrator)), chain_(std::move(chain)), tolerance_(tolerance) {}

  void advance(State& state, double time_step, std::int64_t steps) override;
  std::int64_t forceEvaluations() const override { return integrator_->forceEvaluations(); }
  double dissipatedEnergy() const override {
    return dissipated_before_ + integrator_->dissipatedEnergy();
  }
  Skips skips() const override { return integrator_->skips(); }
  std::string report() const override { return integrator_->report(); }
  void restart() override;

  /// Number of calls of `advance` that found the chain at rest.
  std::int64_t sleptCalls() const { return slept_calls_; }

 private:
  std::unique_ptr<Integrator> integrator_;
  Chain chain_;
  double tolerance_;
  bool asleep_ = false;
  double dissipated_before_ = 0.0;  ///< J, up to the last sleep
  std::int64_t slept_calls_ = 0;
};

}  // namespace spring_pendulum
