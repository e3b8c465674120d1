// Motions that frames are compared with: methods of the table, and programs of students. What counts
// as equal follows from the digits printed and from a companion of the motion: the same motion, disturbed
// by more rounding errors than there are.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/scene.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include "check/frames.hpp"
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
  /// \returns false if `limit` ended it on the way, after which the motion is of no use
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
                                 const Scene& particles);

/// The motion of a program. Copies the program.
std::unique_ptr<Motion> motionOf(const StudentProgram& program, const Scene& particles);

/// Where frames depart from a motion.
struct Departure {
  std::int64_t frame = 0;
  std::ptrdiff_t particle = 0;  ///< the first one, counted from 1
  double distance = 0.0;        ///< m; NaN if the frame has a number that is not finite
  /// Share of the distance along the spring to the previous particle; -1 if there is none.
  double along_spring = -1.0;
  /// What is impossible in a frame that is too late to be compared; empty: it was compared.
  std::string impossible = {};
};

struct Agreement {
  std::size_t frames = 0;              ///< leading frames that agree
  bool complete = false;               ///< whether all frames that could be compared agree
  std::optional<Departure> departure;  ///< in a later frame
  std::int64_t last_frame = -1;        ///< index of the last frame that agrees
};

using MotionMaker = std::function<std::unique_ptr<Motion>()>;

/// Compares until the first frame that differs, or until rounding errors have grown to a thousandth
/// of the size of the motion, after which nothing can be compared, or until the limit is reached.
/// \param chain of the motion: later frames must be finite, and must not have much more potential energy
///   than any state of the motion before. Null: they are not looked at.
Agreement compare(const AllFrames& frames, const MotionMaker& make, WorkLimit& limit,
                  const Chain* chain = nullptr);

}  // namespace spring_pendulum
