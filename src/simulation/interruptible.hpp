// Interrupting a run inside a long frame.
#pragma once

#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace spring_pendulum {

/// Thrown by `InterruptibleIntegrator::advance`; the state is then at a time inside the frame.
struct Interrupted {};

/// Calls another integrator in pieces of about 0.1 s of computing time and checks between them
/// whether to continue. This changes no bit: taking a + b steps equals taking a and then b steps,
/// and for an error-controlled method, n steps of h equal m n steps of h/m if m is a power of 2.
class InterruptibleIntegrator : public Integrator {
 public:
  /// \param error_controlled whether steps are output intervals, which can be divided
  /// \param particles        number of particles of the chain
  /// \param is_interrupted   called between two pieces
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
  std::int64_t parts_;      ///< number of parts of a step
  std::int64_t piece_ = 0;  ///< parts per call; 0: not known yet
  double particles_;
  std::function<bool()> is_interrupted_;
};

/// Makes the integrator of a run.
/// \throws InputError like makeIntegrator and checkTolerance
std::unique_ptr<Integrator> makeInterruptible(const Scenario& scenario, const Chain& chain,
                                              const State& start, bool track_dissipation,
                                              std::function<bool()> is_interrupted);

}  // namespace spring_pendulum
