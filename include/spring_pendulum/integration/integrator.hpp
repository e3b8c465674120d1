// The interface of all integration methods.
#pragma once

#include <spring_pendulum/model/state.hpp>

#include <cstdint>
#include <functional>
#include <string>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Settings of a method.
struct IntegratorOptions {
  double tolerance = 1e-6;         ///< target position error of error-controlled methods, m
  bool track_dissipation = false;  ///< integrate the dissipated power as well
  int threads = 0;                 ///< largest number; 0: one per processor core
};

/// Solves z' = F(z) for one chain. The integrator owns its workspace and does not allocate while
/// stepping; only `Auto` allocates the workspace of a method when it first uses the method. The
/// caller keeps the time, as a step count.
///
/// A fixed-step method takes exactly the requested steps. An error-controlled method chooses its
/// steps itself: there, `time_step` is the interval between output times, at which the method
/// evaluates its dense output.
class Integrator {
 public:
  virtual ~Integrator() = default;
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// Advances `state` in place by `steps` >= 0 steps of `time_step` s. Taking a + b steps in one
  /// call or in two gives the same bits. The first particle does not move unless the chain is driven.
  /// A diverging motion does not throw: the state then has elements that are very large or not finite.
  /// \param stop asked before the first step and after every few milliseconds of work whether to stop
  ///   early; empty: never. To go on, call `advance` again with the remaining steps; a run with stops has
  ///   the bits of a run without.
  /// \returns the number of completed steps. An error-controlled method may stop between two output
  ///   times, which leaves `state` unchanged.
  /// \throws InputError if the size of the state is not that of the chain, `time_step` is not
  ///         finite and positive, or `steps` is negative
  std::int64_t advance(State& state, double time_step, std::int64_t steps,
                       const std::function<bool()>& stop = {});

  /// Nominal computing time since construction, s: numbers of operations times the time that each
  /// takes on one core of a current processor. It is counted, not measured by a clock, so a limit on
  /// it stops every run at the same place on every machine.
  virtual double work() const = 0;

  /// Number of evaluations of F for the whole chain since construction.
  virtual std::int64_t forceEvaluations() const = 0;

  /// Energy in J dissipated by the dashpots since construction or the last restart, integrated with
  /// the order of the method; 0 unless `IntegratorOptions::track_dissipation` is set.
  virtual double dissipatedEnergy() const = 0;

  /// Energy in J that the holders of particles and the applied forces have supplied to the chain since
  /// construction or the last restart. If a method leaves it 0, a run with a drive seems to gain energy or drift.
  virtual double suppliedEnergy() const { return 0.0; }

  /// One line on how the motion was integrated: the methods that `Auto` chose. Empty for all other
  /// methods.
  virtual std::string report() const { return {}; }

  /// Discards what the method keeps between calls and sets the dissipated and the supplied energy to
  /// 0. Call it before passing `advance` a state that is not the one that the last call of `advance`
  /// returned.
  virtual void restart() {}

 protected:
  Integrator() = default;

  /// Takes all steps; see `advance`.
  virtual void integrate(State& state, double time_step, std::int64_t steps) = 0;

  /// Takes steps until `work()` has reached `most_work` s, at least one if it is below.
  /// \returns the number of completed steps; 0 if an error-controlled method has not reached the next
  ///   output time
  virtual std::int64_t integrateWithin(State& state, double time_step, std::int64_t steps,
                                       double most_work);

 private:
  double step_work_ = 0.0;  ///< of the last steps in `integrateWithin`, s per step
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
