// Motions that frames are compared with: methods of the table, and programs of students.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/particles.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <random>

#include "checking/mistakes.hpp"

namespace spring_pendulum {

class Motion {
 public:
  virtual ~Motion() = default;
  Motion(const Motion&) = delete;
  Motion& operator=(const Motion&) = delete;

  /// Moves on to a frame. Frames must not decrease. Adds the work in spring forces to `work`.
  virtual void advanceTo(std::int64_t frame, double& work) = 0;
  /// N×2 positions as the program prints them, m.
  virtual void writePositions(Eigen::ArrayX2d& positions) const = 0;
  /// Changes all numbers by some rounding errors of the steps of a frame.
  virtual void disturb(std::mt19937& random) = 0;
  /// Whether `disturb` must be called at the start only.
  virtual bool isDisturbedOnce() const { return false; }

 protected:
  Motion() = default;
};

/// The motion of a method of the table.
std::unique_ptr<Motion> motionOf(const Method& method, const Scenario& scenario,
                                 const Particles& particles);

/// The motion of a program. Copies the program.
std::unique_ptr<Motion> motionOf(const StudentProgram& program, const Particles& particles);

}  // namespace spring_pendulum
