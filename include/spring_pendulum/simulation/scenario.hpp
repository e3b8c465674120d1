// Everything one run needs. The initialisers are the defaults; there is no second place for them.
#pragma once

#include <spring_pendulum/model/export.hpp>
#include <spring_pendulum/model/spring_law.hpp>

#include <cstdint>
#include <string>

namespace SPRING_PENDULUM_API spring_pendulum {

/// What happens to a run that diverged. It never continues with numbers that are not finite.
enum class OnDivergence { kStop, kContinue };

/// Whether a reference run measures the position error: while it is cheap, to the end, or never.
enum class ReferenceUse { kAuto, kAlways, kNever };

struct Scenario {
  std::string method = "Runge-Kutta-4";
  std::string particles = "particle.txt";  ///< the particle file
  std::string output = ".";                ///< where frame files go
  bool no_frames = false;                  ///< write no frame files
  std::string energy;                      ///< where the energy balance goes; empty: nowhere
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

  double wanted_error = 0.0;  ///< m, for which the check finds the cheapest method; 0: none

  std::int64_t threads = 0;  ///< at most; 0: as many as the processor runs at once
  double sleep = 0.0;        ///< speed below which a chain is at rest, m/s; 0: never

  SpringLaw spring() const { return {stiffness, damping, rest_length}; }
};

}  // namespace spring_pendulum
