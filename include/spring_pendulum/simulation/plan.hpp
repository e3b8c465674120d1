// How a scene is simulated. The initialisers are the defaults, and their only definition.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>

#include <cstdint>
#include <functional>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Action after a divergence. A run never continues with numbers that are not finite.
enum class OnDivergence { kStop, kContinue };

/// Whether a reference run measures the position error: while it is cheap, to the end, or never.
enum class ReferenceUse { kAuto, kAlways, kNever };

struct Plan {
  /// A row of the method table.
  std::reference_wrapper<const Method> method = findMethod("Runge-Kutta-4");
  OnDivergence on_divergence = OnDivergence::kStop;
  ReferenceUse reference = ReferenceUse::kAuto;

  std::int64_t frames = 500;
  std::int64_t steps_per_frame = 10;  ///< fixed-step methods
  double time_step = 0.01;            ///< s, fixed-step methods
  double tolerance = 1e-6;            ///< m, error-controlled methods
  double frame_interval = 0.1;        ///< s, error-controlled methods

  std::int64_t threads = 0;  ///< largest number; 0: one per processor core
  double sleep = 0.0;        ///< speed in m/s below which a chain is at rest; 0: off

  /// Arguments of Integrator::advance from one frame to the next: a fixed step in s and their number, or
  /// the frame interval as one step of an error-controlled method, which chooses its own.
  double step() const { return method.get().hasFixedStep() ? time_step : frame_interval; }
  std::int64_t steps() const { return method.get().hasFixedStep() ? steps_per_frame : 1; }

  /// Returns the time of a frame in s, t = n·Δt with an integer n.
  double timeOfFrame(std::int64_t frame) const {
    return static_cast<double>(frame * steps()) * step();
  }
  /// Returns the plan of the frames from this one on.
  Plan from(std::int64_t frame) const {
    Plan rest = *this;
    rest.frames -= frame;
    return rest;
  }
};

}  // namespace spring_pendulum
#pragma GCC visibility pop
