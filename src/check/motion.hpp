// Frames, and the motions that they are compared with: methods of the table, and programs of students.
// What counts as equal follows from the digits printed and from a companion of the motion: the same motion,
// disturbed by more rounding errors than there are.
#pragma once

#include "io/files/frame_folder.hpp"
#include <spring_pendulum/model/scene.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include "check/mistakes.hpp"

namespace spring_pendulum {

struct FrameNumbers {
  std::int64_t index = 0;
  Eigen::ArrayX2d positions;  ///< N×2, m; nan and inf as printed
  Eigen::ArrayX2d units;      ///< N×2, one unit of the last digit printed, m

  /// \param share of a unit by which numbers may differ
  bool equals(const Eigen::ArrayX2d& numbers, double share) const {
    return ((positions - numbers).abs() <= share * units).all();
  }
};

struct AllFrames {
  std::vector<FrameNumbers> frames;  ///< by increasing index
  int digits = 0;                    ///< largest number of significant digits
  bool are_floats = false;           ///< whether a program in float has written them
  std::int64_t start = 0;            ///< index of the frame that should be the start
  std::vector<std::string> notes;    ///< on missing frames and on the format

  /// If the first frame is the start with another index, lets it have that of the start.
  bool renumber(const Eigen::ArrayX2d& positions);
};

/// \throws FileError naming frame and line
AllFrames readFrames(const std::vector<FrameText>& texts, const Scene& particles);

/// Limits the work of comparisons and fits.
struct WorkLimit {
  double most;                 ///< nominal computing time as in Integrator::work(), s
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
  virtual Eigen::ArrayX2d positions() const { return state_.topRows<2>().transpose(); }
  /// Changes all numbers by some rounding errors of the steps of a frame.
  void disturb(std::mt19937& random);
  /// Error in m that two right results may have besides rounding. If it is not 0, `disturb` must be
  /// called at the start only.
  double tolerance() const { return plan_.method.get().hasFixedStep() ? 0.0 : plan_.tolerance; }

 protected:
  Motion(const Plan& plan, const Scene& particles);

  Plan plan_;
  std::int64_t frame_;                                         ///< of the state
  Eigen::Array4Xd state_;                                      ///< x, y, vx, vy by particle
  double precision_ = std::numeric_limits<double>::epsilon();  ///< relative, of the numbers
  bool is_disturbed_ = false;
};

/// The motion of the method of a plan. It starts at the frame of the particles.
std::unique_ptr<Motion> motionOf(const Plan& plan, const Chain& chain, const Scene& particles);

/// The motion of a program. Copies the program.
std::unique_ptr<Motion> motionOf(const StudentProgram& program, const Scene& particles);

/// Where frames depart from a motion.
struct Departure {
  std::int64_t frame;
  double distance;          ///< m; NaN if the frame has a number that is not finite
  std::string text;         ///< "particle 2, by 6.9e-06 m along its spring"
  bool is_compared = true;  ///< else, the frame is too late to be compared, but impossible
};

struct Agreement {
  std::size_t frames = 0;              ///< leading frames that agree
  bool complete = false;               ///< whether all frames that could be compared agree
  std::optional<Departure> departure;  ///< in a later frame
  std::int64_t last_frame = -1;        ///< index of the last frame that agrees
};

/// Compares until the first frame that differs, or until rounding errors have grown to a thousandth
/// of the size of the motion, after which nothing can be compared, or until the limit is reached.
/// \param companion the same motion
/// \param chain of the motion: later frames must be finite, and must not have much more potential energy
///   than any state of the motion before. Null: they are not looked at.
Agreement compare(const AllFrames& frames, Motion& motion, Motion& companion, WorkLimit& limit,
                  const Chain* chain = nullptr);

}  // namespace spring_pendulum
