// Frames, and the motions that they are compared with: methods of the table, and programs of students.
// What counts as equal follows from the digits printed and from two companions of the motion: the same
// motion, disturbed by more rounding errors than there are.
#pragma once

#include "io/files/frame_folder.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/scene.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {

struct FrameNumbers {
  std::int64_t index = 0;
  Eigen::ArrayX2d positions;  ///< N×2, m; nan and inf as printed
  Eigen::ArrayX2d units;      ///< N×2, one unit of the last digit printed, m

  /// \param share of a unit by which finite numbers may differ, besides the rounding to double
  bool equals(const Eigen::ArrayX2d& numbers, double share) const {
    return ((positions - numbers).abs() <= share * units + 0x1p-52 * positions.abs() ||
            (!positions.isFinite() && !numbers.isFinite()))
        .all();
  }
  bool equalsFloatsOf(const Eigen::ArrayX2d& numbers, double share) const {
    return equals(numbers.cast<float>().cast<double>(), share);
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
AllFrames readFrames(std::vector<FrameText> texts, const Scene& particles);

/// The force of a spring on a particle, as a program computes it:
///
///     stiffness (length - rest_length) direction + damping damped
struct StudentSpring {
  Eigen::Array2d separation;                 ///< from the particle to its neighbour, m
  Eigen::Array2d relative_velocity;          ///< of the neighbour, m/s
  Eigen::Array2d velocity;                   ///< of the particle, m/s
  bool to_previous;                          ///< whether the neighbour is the previous particle
  double start_length, rest_length, length;  ///< m
  Eigen::Array2d direction = {0.0, 0.0};
  Eigen::Array2d damped = {0.0, 0.0};  ///< m/s

  void pointTo(const Eigen::Array2d& r) {
    direction = r;
    damped = (relative_velocity * r).sum() * r;
  }
};

/// A particle, as a program accelerates it:
///
///     (left × force from the left + right × force from the right - drag |v|^drag_power v) / divisor + gravity
struct StudentParticle {
  std::ptrdiff_t index, last;
  double mass, previous_mass, next_mass;  ///< kg
  double drag;                            ///< N·s/m
  Eigen::Array2d gravity;                 ///< m/s²
  double divisor = mass;                  ///< kg
  double left = 1.0, right = 1.0;
  double drag_power = 0.0;
  bool moves = index > 0;
};

/// A particle's way to the next stage of a step, or to its end. Rows are x, y, vx, vy.
struct StudentMove {
  Eigen::Array4d start, first_slope, result;
  double step;     ///< s
  double time;     ///< from the start to the result, s
  bool ends_step;  ///< whether this is the result of the step

  void moveWith(const Eigen::Array2d& velocity) {
    result.head<2>() = start.head<2>() + time * velocity;
  }
};

struct Mistake;

/// The exercise with whatever is changed in it, also in plan and constants: a time step of 0 moves nothing.
struct StudentProgram : Plan, Constants {
  /// Kinds of programs, as bits: a mistake concerns some of them.
  static constexpr unsigned kEuler = 1, kMidpoint = 2, kHeun = 4, kRungeKutta4 = 8;
  static constexpr unsigned kOtherTableau = 16, kSymplectic = 32, kImplicit = 64;
  /// When the numbers of a particle are overwritten.
  enum class Order {
    kTogether,
    kStagesInPlace,     ///< at once: later particles use the next stage of earlier ones
    kPositionsInPlace,  ///< the same for the positions only
    kParticlesInPlace,  ///< a particle takes its whole step before the next one
    kForceAfterMove     ///< all positions take the step before the forces are computed
  };

  unsigned kinds;
  ButcherTableau tableau;
  bool is_linearised = false;  ///< an implicit method that solves a linear system per step
  Order order = Order::kTogether;
  std::int64_t first_step = 0;  ///< steps before frame 0; negative: the start is repeated
  double right_steps = static_cast<double>(steps_per_frame);  ///< of the right program, per frame
  bool single_precision = false;
  /// Changes of a spring, of a particle, of a way, and of the numbers that are printed.
  std::vector<void (*)(StudentSpring&)> springs = {};
  std::vector<void (*)(StudentParticle&)> particles = {};
  std::vector<void (*)(StudentMove&)> moves = {};
  std::vector<void (*)(Eigen::Array4Xd&)> prints = {};
  /// Short names of the mistakes that were made, "heun" or "g", and for each a sentence for the student.
  std::vector<std::string> mistakes = {}, sentences = {};
  std::int64_t last_frame = 0;  ///< the mistakes reproduce the frames up to this one

  /// The right program for a method that students write.
  StudentProgram(const Method& wanted, const Scenario& scenario);

  bool canMake(const Mistake& mistake) const;
  StudentProgram with(const Mistake& mistake) const;
};

/// Returns the kind of the programs for a method; 0 if students do not write them.
unsigned kindOf(const Method& method);

struct Mistake {
  std::string_view name;      ///< several rows may share a name
  unsigned kinds;             ///< of the programs in which it can be made; 0: it is tried by itself
  std::string_view sentence;  ///< follows "the program "
  void (*make)(StudentProgram&);
};

/// A number that is fitted.
struct Constant {
  std::string_view name;
  std::string_view sentence;  ///< follows "the program "; {} is the number
  double& (*in)(StudentProgram&);
};

const std::vector<Mistake>& knownMistakes();
const std::vector<Constant>& fittedConstants();

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
  /// Changes all numbers by some rounding errors of the steps of a frame plus a tenth of the tolerance.
  /// \param off_line also those that are equal in all particles of a straight chain
  void disturb(std::mt19937& random, bool off_line);
  /// Error in m that two right results may have besides rounding. If it is not 0, `disturb` must be
  /// called at the start only.
  double tolerance() const { return plan_.method.get().hasFixedStep() ? 0.0 : plan_.tolerance; }
  double share() const { return share_; }  ///< part of the rounding errors that is allowed

 protected:
  Motion(const Plan& plan, const Scene& particles);

  Plan plan_;
  std::int64_t frame_;                                         ///< of the state
  Eigen::Array4Xd state_;                                      ///< x, y, vx, vy by particle
  double precision_ = std::numeric_limits<double>::epsilon();  ///< relative, of the numbers
  double share_ = 1.0;
  bool is_disturbed_ = false;
};

/// The motion of the method of a plan, or of a program. It starts at the frame of the particles.
std::unique_ptr<Motion> motionOf(const Plan& plan, const Chain& chain, const Scene& particles);
std::unique_ptr<Motion> motionOf(const StudentProgram& program, const Scene& particles);

/// Where frames depart from a motion.
struct Departure {
  std::int64_t frame;
  double distance;   ///< m; not finite if a number is not, or too large
  std::string text;  ///< "particle 2, by 7.9e-06 m"
};

struct Agreement {
  std::size_t frames = 0;              ///< leading frames that agree
  std::vector<double> roundings;       ///< rounding errors in each of these, m
  bool complete = false;               ///< whether all frames that could be compared agree
  std::optional<Departure> departure;  ///< in a later frame
  std::int64_t last_frame = -1;        ///< index of the last frame that agrees
};

/// Compares until the first frame that differs, or until rounding errors have grown to a thousandth
/// of the size of the motion, after which nothing can be compared, or until the limit is reached.
/// \param make  makes the motion, also for its companions
Agreement compare(const AllFrames& frames, const std::function<std::unique_ptr<Motion>()>& make,
                  WorkLimit& limit, bool off_line = false);

}  // namespace spring_pendulum
