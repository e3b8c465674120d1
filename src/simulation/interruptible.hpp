// A long frame that can be interrupted.
#pragma once

#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace spring_pendulum {

/// Thrown out of `InterruptibleIntegrator::advance`; the state is then somewhere inside the frame.
struct Interrupted {};

/// Hands a state to another integrator in pieces of about a tenth of a second of computing, and
/// asks between them whether to go on. No bit of the result changes: `advance` gives the same for
/// a + b steps as for a steps and then b, and for n steps of h as for m n steps of h/m, with m a
/// power of 2, if the method controls its error.
class InterruptibleIntegrator : public Integrator {
 public:
  /// \param error_controlled whether a step may be cut, as it is only a distance of output times
  /// \param particles        of the chain
  /// \param is_interrupted   asked between two pieces
  InterruptibleIntegrator(std::unique_ptr<Integrator> integrator, bool error_controlled,
                          Eigen::Index particles, std::function<bool()> is_interrupted);

  /// \throws Interrupted
  void advance(State& state, double time_step, std::int64_t steps) override;
  std::int64_t forceEvaluations() const override { return integrator_->forceEvaluations(); }
  double dissipatedEnergy() const override { return integrator_->dissipatedEnergy(); }
  Skips skips() const override { return integrator_->skips(); }
  std::string report() const override { return integrator_->report(); }
  void restart() override { integrator_->restart(); }

 private:
  std::int64_t firstPiece(double part) const;

  std::unique_ptr<Integrator> integrator_;
  std::int64_t parts_;      ///< of a step
  std::int64_t piece_ = 0;  ///< parts in a call; 0: not known yet
  double particles_;
  std::function<bool()> is_interrupted_;
};

/// The integrator of a run.
/// \throws InputError as makeIntegrator and checkTolerance
std::unique_ptr<Integrator> makeInterruptible(const Scenario& scenario, const Chain& chain,
                                              const State& start, bool track_dissipation,
                                              std::function<bool()> is_interrupted);

}  // namespace spring_pendulum
