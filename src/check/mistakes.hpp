// A program that a student may have written, the known mistakes in it, and its numbers that may be wrong.
#pragma once

#include <spring_pendulum/integration/butcher_tableau.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace spring_pendulum {

/// The exercise with whatever is changed in it. The initialisers are the right program.
struct StudentProgram {
  enum class Damping { kProjected, kWhole, kOwn, kNotUnit, kAbsolute };
  enum class Direction { kUnit, kSeparation, kDegrees, kDegreesOfSpring };
  enum class Length { kRight, kInteger, kSquared, kSquaredEverywhere };
  enum class Springs { kAll, kAllButLast, kEverySecond };
  /// The velocity by which a position is moved.
  enum class PositionUpdate {
    kSlopes,
    kNewVelocityInResult,
    kNewVelocityInStages,
    kNewVelocityEverywhere,
    kNewVelocityInSlopes,  ///< each slope of a position is v + h a
    kOldVelocity           ///< the one at the begin of the step
  };
  /// When the numbers of a particle are overwritten.
  enum class Order {
    kTogether,
    kStagesInPlace,     ///< at once: later particles use the next stage of earlier ones
    kPositionsInPlace,  ///< the same for the positions only
    kParticlesInPlace,  ///< a particle takes its whole step before the next one
    kFrozenNeighbours,  ///< the same, but with neighbours at the begin of the step
    kForceAfterMove     ///< all positions take the step before the forces are computed
  };
  enum class StageMoves { kBoth, kPositions, kVelocities };

  ButcherTableau tableau;
  double time_step;  ///< s; 0: nothing moves
  std::int64_t steps_per_frame;
  std::int64_t first_step = 0;     ///< steps before frame 0; negative: the start is repeated
  double stiffness;                ///< N/m
  double damping;                  ///< N·s/m
  double rest_length;              ///< m
  double gravity;                  ///< m/s²
  double gravity_x = 0.0;          ///< m/s²
  double left = 1.0;               ///< factor of the force of the spring to the previous particle
  double right = 1.0;              ///< factor of the force of the spring to the next particle
  double force_mass_power = -1.0;  ///< the force is multiplied by this power of the mass
  double gravity_mass_power = 0.0;
  int mass_of = 0;  ///< -1, 1: the mass of the previous or the next particle divides the force
  bool gravity_on_last_only = false;
  bool rest_length_from_start = false;
  bool first_moves = false;
  bool last_moves = true;
  bool swaps_columns = false;
  bool reverses_particles = false;
  bool single_precision = false;
  bool velocity_by_euler = false;
  Damping damping_kind = Damping::kProjected;
  Direction direction = Direction::kUnit;
  Length length = Length::kRight;
  Springs springs = Springs::kAll;
  PositionUpdate position_update = PositionUpdate::kSlopes;
  Order order = Order::kTogether;
  StageMoves stage_moves = StageMoves::kBoth;

  StudentProgram(const ButcherTableau& method, const Scenario& scenario)
      : tableau(method),
        time_step(scenario.time_step),
        steps_per_frame(scenario.steps_per_frame),
        stiffness(scenario.stiffness),
        damping(scenario.damping),
        rest_length(scenario.rest_length),
        gravity(scenario.gravity) {}

  std::int64_t stepOfFrame(std::int64_t frame) const {
    return std::max<std::int64_t>(0, first_step + frame * steps_per_frame);
  }
};

/// For methods with any number of stages, or with more than one.
inline constexpr std::size_t kAnyStages = 0;
inline constexpr std::size_t kSeveralStages = 100;

struct Mistake {
  std::string_view name;      ///< several rows may share a name
  std::size_t stages;         ///< of the methods in which it can be made
  std::string_view sentence;  ///< follows "the program "
  void (*make)(StudentProgram&);

  bool concerns(const StudentProgram& program) const {
    return stages == kAnyStages || stages == program.tableau.stages ||
           (stages == kSeveralStages && program.tableau.stages > 1);
  }
};

/// A number that is fitted.
struct Constant {
  std::string_view name;
  std::string_view sentence;  ///< follows "the program "; {} is the number
  double StudentProgram::*member;
};

const std::vector<Mistake>& knownMistakes();
const std::vector<Constant>& fittedConstants();

}  // namespace spring_pendulum
