// Who holds which particle, and the accelerations that bring held particles to their targets.
#pragma once

#include "ros/inputs/input_messages.hpp"
#include <spring_pendulum/simulation/run.hpp>

#include <cstddef>
#include <map>
#include <memory>
#include <vector>

namespace spring_pendulum {

/// Where a held particle shall be.
struct Target {
  PlaneVector<double> position{};      ///< m
  PlaneVector<double> velocity{};      ///< m/s
  PlaneVector<double> acceleration{};  ///< m/s²
};

/// A force that acts for a while.
struct TimedForce {
  std::ptrdiff_t particle = 0;  ///< counted from 0
  PlaneVector<double> force{};  ///< N
  double begin = 0.0;           ///< s of simulated time
  double end = 0.0;             ///< s of simulated time
};

/// Collects what acts on a run, and changes the run between two of its states. Particles are counted
/// from 0. In each interval between two states a held particle has the constant acceleration that
/// brings it to rest relative to its target within two intervals.
class Holders {
 public:
  /// \param log learns of every change; must outlive the holders
  explicit Holders(const Run& run, InputLog* log = nullptr);

  /// Holds a particle, or sets a new target for a held one.
  void hold(std::ptrdiff_t particle, const Target& target) { targets_[particle] = target; }
  /// Holds a particle where it is.
  void hold(std::ptrdiff_t particle);
  /// Lets go of a particle, which keeps its velocity; P_1 stops where it is.
  void release(std::ptrdiff_t particle);
  bool isHeld(std::ptrdiff_t particle) const { return targets_.count(particle) > 0; }

  /// Returns false if a thousand forces act already.
  bool push(const TimedForce& force);
  /// Returns the number of forces that acted or were to act.
  std::size_t clearForces();

  /// The scenario whose method and constants hold from the next state on.
  Scenario& wanted() { return wanted_; }
  /// Continues from another state.
  void jumpTo(const State& state) { jump_ = std::make_unique<State>(state); }

  /// Changes the run for the interval until `next_time` s, if anything has changed.
  /// \param paused places held particles at their targets instead, at rest
  /// \throws InputError as Run::change; forgets what the run cannot do
  void apply(Run& run, std::unique_ptr<Integrator>& integrator, double next_time, bool paused);

  /// Lets go of everything and returns the run to its start, or to a frame and the state at it.
  void reset(Run& run, std::unique_ptr<Integrator>& integrator, const Particles* to = nullptr);

 private:
  Drive driveUntil(double next_time, State& state);
  /// What is wanted, with the method of the run if the methods can change at a frame only.
  Scenario possible() const;

  const Run& run_;
  InputLog* log_;
  double fastest_;  ///< m/s, of a particle on the way to its target
  Scenario wanted_;
  std::map<std::ptrdiff_t, Target> targets_;
  std::vector<TimedForce> forces_;
  std::unique_ptr<State> jump_;
};

}  // namespace spring_pendulum
