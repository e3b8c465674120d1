// The common interface of all methods that carry a chain through time.
#pragma once

#include <spring_pendulum/model/export.hpp>
#include <spring_pendulum/model/state.hpp>

#include <cstdint>
#include <string>

namespace SPRING_PENDULUM_API spring_pendulum {

/// Settings of a method.
struct IntegratorOptions {
  double tolerance = 1e-6;         ///< error-controlled methods: wanted position error, m
  bool track_dissipation = false;  ///< integrate the dissipated power too
  int threads = 0;                 ///< at most; 0: as many as the processor runs at once
};

/// Work that a method leaves out because the chain does not need it. No bit of a result changes.
struct Skips {
  bool damping = false;  ///< no dashpots: no velocity differences
  bool gravity = false;  ///< none to add
  bool masses = false;   ///< all equal: none is read
};

/// Solves z' = F(z) for the chain it was made for. The workspace belongs to the integrator and is
/// allocated when it is made, never while stepping. Time belongs to the caller, as a step count.
///
/// A fixed-step method takes exactly the steps it is told. An error-controlled method takes steps
/// of its own and is evaluated (dense output) at the multiples of `time_step`, which for it is only
/// the distance of the output times.
class Integrator {
 public:
  virtual ~Integrator() = default;
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// Moves `state` on by `steps` >= 0 steps of `time_step` s, in place. Taking a + b steps in one
  /// call or in two gives the same bits. The first particle does not move.
  /// Never throws for a numerical reason: a motion that diverges shows in the state.
  /// \throws InputError if the state is not of the chain's size,
  ///         `time_step` is not finite and above 0, or `steps` is negative
  virtual void advance(State& state, double time_step, std::int64_t steps) = 0;

  /// How often F was evaluated for the whole chain since the integrator was made.
  virtual std::int64_t forceEvaluations() const = 0;

  /// Heat in J that the dashpots took up since the integrator was made or restarted, integrated
  /// with the method's own order; 0 unless `IntegratorOptions::track_dissipation` is set.
  virtual double dissipatedEnergy() const = 0;

  /// What this method skips for its chain.
  virtual Skips skips() const { return {}; }

  /// What a user should know of how the motion was integrated, in one line: the methods `Auto`
  /// chose. Empty if there is nothing to tell.
  virtual std::string report() const { return {}; }

  /// Tells that the next `advance` gets a state that the last one did not return. Only methods that
  /// remember something between calls care.
  virtual void restart() {}

 protected:
  Integrator() = default;
};

}  // namespace spring_pendulum
