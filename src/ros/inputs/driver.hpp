// What acts on a run from outside: held particles, forces, changed constants.
#pragma once

#include "ros/inputs/input_messages.hpp"
#include "ros/inputs/requests.hpp"
#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace spring_pendulum {

/// Collects what acts on a run, and changes the run between two of its states. Particles are counted
/// from 0. In each interval between two states a held particle has a constant acceleration, so that it
/// comes to rest relative to its target: within two intervals, or smoothly if they are short.
class Driver {
 public:
  /// \param log learns of every change; must outlive the driver
  /// \param settling s; at shorter intervals, held particles come to rest with this time constant
  explicit Driver(const Run& run, InputLog* log = nullptr, double settling = 0.0);

  /// Act on a request from the next state on, see RequestHandler.
  std::string on(const SetConstant& request);
  std::string on(const ApplyForceTo& request);
  std::string on(const ClearForces& request);
  std::string on(const ComeToRest& request);
  /// Holds a particle, or sets a new target for a held one.
  std::string on(const Hold& request);
  /// Lets go of a particle, which keeps its velocity; P_1 stops where it is.
  std::string on(const Release& request);

  bool isActing() const { return !targets_.empty() || !forces_.empty(); }  ///< now or later
  bool isHeld(std::ptrdiff_t particle) const { return targets_.count(particle) > 0; }

  /// Changes the run for the interval until `next_time` s, if anything has changed.
  /// \param paused places held particles at their targets instead, at rest
  /// \throws InputError as Run::change; forgets what the run cannot do
  void apply(Run& run, double next_time, bool paused);

  /// Lets go of everything and returns the run to its start, or to a frame and the state at it.
  void reset(Run& run, const Scene* to = nullptr);

 private:
  Drive driveUntil(double next_time, State& state);

  const Run& run_;
  InputLog* log_;
  double settling_;  ///< s
  double fastest_;   ///< m/s, of a particle relative to a target that does not say
  Scenario wanted_;
  std::map<std::ptrdiff_t, Target> targets_;
  std::vector<ApplyForceTo> forces_;  ///< with infinite durations instead of negative ones
  std::unique_ptr<State> jump_;
};

}  // namespace spring_pendulum
