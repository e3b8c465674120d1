// Integrates a driven chain with any method, in the frame of P_1.
//
// P_1 moves with constant acceleration. In its frame it is at rest, the other particles fall with
// other constant accelerations, and the methods need not know that it moves. The state that a caller
// sees is that of the frame at rest.
//
// With air, which is at rest, the chain is seen from a particle at rest before P_1 instead:
// `Chain::behindRest`.
//
// The power of the holders of other particles is integrated along with the motion. The work that
// gravity, applied forces and the holder of P_1 do on the chain follows from the two ends of the
// motion: constant accelerations have a potential.
#pragma once

#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <memory>

namespace spring_pendulum {

class DrivenIntegrator final : public Integrator {
 public:
  /// \param chain      a driven chain; with air, the result of `behindRest`
  /// \param relative   for `chain.seenFromAnchor()`
  /// \param fixed_step whether `relative` takes the given steps
  DrivenIntegrator(const Chain& chain, std::unique_ptr<Integrator> relative, bool fixed_step);

  /// Held particles are at their prescribed places after every step of a fixed-step method, which
  /// may not integrate a constant acceleration exactly, and at every output time.
  void integrate(State& state, double time_step, std::int64_t steps) override;
  std::int64_t integrateWithin(State& state, double time_step, std::int64_t steps,
                               double most_work) override;
  double work() const override { return relative_->work(); }
  std::int64_t forceEvaluations() const override { return relative_->forceEvaluations(); }
  double dissipatedEnergy() const override { return relative_->dissipatedEnergy(); }
  double suppliedEnergy() const override;
  void restart() override;
  std::string report() const override { return relative_->report(); }

 private:
  void begin(const State& state);
  /// Number of particles that the caller sees.
  std::ptrdiff_t size() const { return chain_.size() - chain_.firstSpring(); }
  double time() const { return origin_ + static_cast<double>(steps_) * time_step_; }
  /// Displacement and velocity of P_1 since the start.
  PlaneVector<double> displacement() const;
  PlaneVector<double> velocity() const;
  /// Puts the held particles of `state_` where they belong at `time()`.
  void placeHeld();
  /// Energy of the frame at rest minus that of the frame of P_1, both with all potentials, J.
  double energyDifference() const;

  Chain chain_;
  std::unique_ptr<Integrator> relative_;
  bool fixed_step_;
  bool started_ = false;
  PlaneVector<double> acceleration_;      ///< of P_1
  PlaneVector<double> start_velocity_{};  ///< of P_1
  State start_;                           ///< relative to P_1
  State state_;                           ///< relative to P_1
  double origin_ = 0.0;                   ///< time of the first step of `time_step_`, s
  double time_step_ = 0.0;
  std::int64_t steps_ = 0;
  double start_difference_ = 0.0;  ///< J
};

}  // namespace spring_pendulum
