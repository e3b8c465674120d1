// Motions that frames are compared with: methods of the table, and programs of students.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/particles.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <memory>
#include <random>

#include "check/mistakes.hpp"

namespace spring_pendulum {

/// Limits the work of comparisons and fits.
struct WorkLimit {
  double most;                 ///< spring forces of the library; others count more
  std::function<bool()> stop;  ///< empty: never
  double done = 0.0;

  bool isStopped() const { return stop && stop(); }
  bool isOver() const { return done > most || isStopped(); }
};

class Motion {
 public:
  virtual ~Motion() = default;
  Motion(const Motion&) = delete;
  Motion& operator=(const Motion&) = delete;

  /// Moves on to a frame and counts the work. Frames must not decrease.
  /// \returns false if `limit` was stopped on the way, after which the motion is of no use
  virtual bool advanceTo(std::int64_t frame, WorkLimit& limit) = 0;
  /// N×2 positions as the program prints them, m.
  virtual Eigen::ArrayX2d positions() const = 0;
  /// Changes all numbers by some rounding errors of the steps of a frame.
  virtual void disturb(std::mt19937& random) = 0;
  /// Error in m that two right results may have besides rounding. If it is not 0, `disturb` must be
  /// called at the start only.
  virtual double tolerance() const { return 0.0; }

 protected:
  Motion() = default;
};

/// The motion of a method of the table. It starts at the frame of the particles.
std::unique_ptr<Motion> motionOf(const Method& method, const Scenario& scenario,
                                 const Particles& particles);

/// The motion of a program. Copies the program.
std::unique_ptr<Motion> motionOf(const StudentProgram& program, const Particles& particles);

}  // namespace spring_pendulum
