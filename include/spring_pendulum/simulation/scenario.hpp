// All options of a run. The initialisers are the defaults, and their only definition.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/spring_law.hpp>

#include <cstdint>
#include <functional>
#include <string>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Action after a divergence. A run never continues with numbers that are not finite.
enum class OnDivergence { kStop, kContinue };

/// Where a run starts: as the particle file says, or in the equilibrium of the chain.
enum class Start { kFile, kAtRest };

/// Whether a reference run measures the position error: while it is cheap, to the end, or never.
enum class ReferenceUse { kAuto, kAlways, kNever };

struct Scenario {
  /// A row of the method table.
  std::reference_wrapper<const Method> method = findMethod("Runge-Kutta-4");
  std::string particles = "particle.txt";  ///< the particle file
  std::string output = ".";                ///< folder for frame files
  bool no_frames = false;                  ///< write no frame files
  std::string energy;                      ///< file for the energy balance; empty: none
  std::string save_state;                  ///< file for the state at the last frame; empty: none
  bool resume = false;                     ///< go on from the frame of the state file `particles`
  Start start = Start::kFile;
  OnDivergence on_divergence = OnDivergence::kStop;
  ReferenceUse reference = ReferenceUse::kAuto;

  std::int64_t frames = 500;
  std::int64_t steps_per_frame = 10;  ///< fixed-step methods
  double time_step = 0.01;            ///< s, fixed-step methods
  double tolerance = 1e-6;            ///< m, error-controlled methods
  double frame_interval = 0.1;        ///< s, error-controlled methods

  double stiffness = SpringLaw{}.stiffness;      ///< N/m
  double damping = SpringLaw{}.damping;          ///< N·s/m
  double rest_length = SpringLaw{}.rest_length;  ///< m
  double gravity = 9.81;                         ///< m/s²
  double air_drag = 0.0;                         ///< N·s/m

  std::int64_t threads = 0;  ///< largest number; 0: one per processor core
  double sleep = 0.0;        ///< speed in m/s below which a chain is at rest; 0: off

  SpringLaw spring() const { return {stiffness, damping, rest_length}; }
  /// Returns the chain of particles with these masses in kg.
  Chain chainOf(const AlignedNumbers& masses) const {
    return Chain(masses, spring(), gravity).inAir(air_drag);
  }
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
