// One line per mistake, roughly in the order in which they are likely: if several reproduce the same
// frames, the first is reported first.
#include "check/mistakes.hpp"

#include <utility>

namespace spring_pendulum {
namespace {

using P = StudentProgram;
using Update = StudentProgram::PositionUpdate;
using Order = StudentProgram::Order;
using Damping = StudentProgram::Damping;
using Stage = StudentProgram::StageMoves;
using Direction = StudentProgram::Direction;
using Length = StudentProgram::Length;
using Springs = StudentProgram::Springs;

constexpr std::size_t kAny = kAnyStages;
constexpr std::size_t kSeveral = kSeveralStages;

/// Row i of the tableau: the stage, counted from 1, starts with these slopes.
void stage(P& p, std::size_t i, double a, double b = 0.0, double c = 0.0) {
  p.tableau.a.at(i - 1) = {a, b, c};
}

void weights(P& p, double a, double b, double c = 0.0, double d = 0.0) {
  p.tableau.b = {a, b, c, d};
}

/// The weights of Runge-Kutta-4 as a student writes them: multiples of 1 / divisor.
void fourth(P& p, double divisor, double a, double b, double c, double d) {
  weights(p, a / divisor, b / divisor, c / divisor, d / divisor);
}

}  // namespace

// clang-format off
// NOLINTNEXTLINE(readability-function-size): data
const std::vector<Mistake>& knownMistakes() {
  static const std::vector<Mistake> kTable = {
      // The method
      {"heun", 2, "averages the slopes at both ends of the step (Heun) instead of taking the one in the middle", [](P& p) { stage(p, 2, 1); weights(p, 0.5, 0.5); }},
      {"ralston", 2, "uses Ralston's rule instead of the midpoint", [](P& p) { stage(p, 2, 2.0 / 3); weights(p, 0.25, 0.75); }},
      {"semi_implicit", kAny, "moves the positions with the velocities that are already updated (semi-implicit)", [](P& p) { p.position_update = Update::kNewVelocityInResult; }},
      {"semi_implicit_stages", kSeveral, "moves the positions of a stage with the velocities of the same stage", [](P& p) { p.position_update = Update::kNewVelocityInStages; }},
      {"semi_implicit_stages", kSeveral, "moves the positions with the velocities already updated, in stages and at the end of the step", [](P& p) { p.position_update = Update::kNewVelocityEverywhere; }},
      {"semi_implicit_stages", kSeveral, "takes v + h a, the velocity already updated, as slope of the positions", [](P& p) { p.position_update = Update::kNewVelocityInSlopes; }},
      {"force_after_move", 1, "computes the forces after it has moved the positions", [](P& p) { p.order = Order::kForceAfterMove; }},
      {"old_velocity", kSeveral, "moves the positions with the velocity at the begin of the step, as Euler does", [](P& p) { p.position_update = Update::kOldVelocity; }},
      {"old_force", kSeveral, "changes the velocities with the force at the begin of the step, as Euler does", [](P& p) { p.velocity_by_euler = true; }},
      {"stage_velocity", kSeveral, "does not change the velocities in the stages, only the positions", [](P& p) { p.stage_moves = Stage::kPositions; }},
      {"stage_position", kSeveral, "does not change the positions in the stages, only the velocities", [](P& p) { p.stage_moves = Stage::kVelocities; }},
      {"stage_fraction", 2, "goes a whole step to its second slope instead of half a step", [](P& p) { stage(p, 2, 1); }},
      {"stage_fraction", 2, "goes a quarter of a step to its second slope instead of half a step", [](P& p) { stage(p, 2, 0.25); }},
      {"stage_fraction", 2, "takes half a step with the second slope instead of a whole one", [](P& p) { weights(p, 0, 0.5); }},
      {"stage_slope", 2, "starts the step with the second slope from the middle instead of the begin of the step", [](P& p) { weights(p, 0.5, 1); }},
      {"weights", 2, "adds both slopes without halving the sum", [](P& p) { weights(p, 1, 1); }},
      {"weights", 2, "takes the mean of the first slope and the one in the middle", [](P& p) { weights(p, 0.5, 0.5); }},
      {"weights", 4, "weights the slopes 1, 1, 1, 1 (over 4) instead of 1, 2, 2, 1 (over 6)", [](P& p) { fourth(p, 4, 1, 1, 1, 1); }},
      {"weights", 4, "weights the slopes 1, 1, 1, 1 (over 6) instead of 1, 2, 2, 1 (over 6)", [](P& p) { fourth(p, 6, 1, 1, 1, 1); }},
      {"weights", 4, "weights the slopes 1, 3, 3, 1 (over 8) instead of 1, 2, 2, 1 (over 6)", [](P& p) { fourth(p, 8, 1, 3, 3, 1); }},
      {"weights", 4, "weights the slopes 2, 1, 1, 2 (over 6) instead of 1, 2, 2, 1 (over 6)", [](P& p) { fourth(p, 6, 2, 1, 1, 2); }},
      {"weights", 4, "weights the slopes 1, 2, 1, 2 (over 6) instead of 1, 2, 2, 1 (over 6)", [](P& p) { fourth(p, 6, 1, 2, 1, 2); }},
      {"weights", 4, "weights the slopes 2, 1, 2, 1 (over 6) instead of 1, 2, 2, 1 (over 6)", [](P& p) { fourth(p, 6, 2, 1, 2, 1); }},
      {"weights", 4, "weights the slopes 1, 1, 2, 2 (over 6) instead of 1, 2, 2, 1 (over 6)", [](P& p) { fourth(p, 6, 1, 1, 2, 2); }},
      {"weights", 4, "weights the slopes 1, 2, 2, 1 (over 5) instead of dividing by 6", [](P& p) { fourth(p, 5, 1, 2, 2, 1); }},
      {"weights", 4, "weights the slopes 1, 2, 2, 1 (over 8) instead of dividing by 6", [](P& p) { fourth(p, 8, 1, 2, 2, 1); }},
      {"weights", 4, "weights the slopes 1, 2, 2, 1 (over 4) instead of dividing by 6", [](P& p) { fourth(p, 4, 1, 2, 2, 1); }},
      {"weights", 4, "weights the slopes 1, 2, 2, 1 (over 3) instead of dividing by 6", [](P& p) { fourth(p, 3, 1, 2, 2, 1); }},
      {"weights", 4, "takes only the fourth slope", [](P& p) { weights(p, 0, 0, 0, 1); }},
      {"weights", 4, "takes only the third slope", [](P& p) { weights(p, 0, 0, 1, 0); }},
      {"weights", 4, "takes only the mean of the second and third slopes", [](P& p) { weights(p, 0, 0.5, 0.5, 0); }},
      {"weights", 4, "takes only the mean of the first and fourth slopes", [](P& p) { weights(p, 0.5, 0, 0, 0.5); }},
      {"stage_slope", 4, "starts the third stage with the first slope instead of the second", [](P& p) { stage(p, 3, 0.5); }},
      {"stage_slope", 4, "starts the fourth stage with the second slope instead of the third", [](P& p) { stage(p, 4, 0, 1); }},
      {"stage_slope", 4, "starts the fourth stage with the first slope instead of the third", [](P& p) { stage(p, 4, 1); }},
      {"stage_slope", 4, "starts all stages with the first slope", [](P& p) { stage(p, 3, 0.5); stage(p, 4, 1); }},
      {"stage_slope", 4, "starts the third and fourth stages from the stage before instead of the begin of the step", [](P& p) { stage(p, 3, 0.5, 0.5); stage(p, 4, 0.5, 0.5, 1); }},
      {"stage_slope", 4, "starts the third stage from the second instead of the begin of the step", [](P& p) { stage(p, 3, 0.5, 0.5); }},
      {"stage_slope", 4, "starts the fourth stage from the third instead of the begin of the step", [](P& p) { stage(p, 4, 0, 0.5, 1); }},
      {"stage_slope", 4, "computes the second slope at the begin of the step", [](P& p) { stage(p, 2, 0); }},
      {"stage_slope", 4, "computes the third slope at the begin of the step", [](P& p) { stage(p, 3, 0); }},
      {"stage_slope", 4, "computes the fourth slope at the begin of the step", [](P& p) { stage(p, 4, 0); }},
      {"stage_fraction", 4, "goes half a step to the fourth slope instead of a whole one", [](P& p) { stage(p, 4, 0, 0, 0.5); }},
      {"stage_fraction", 4, "goes a whole step to the third slope instead of half a step", [](P& p) { stage(p, 3, 0, 1); }},
      {"stage_fraction", 4, "goes a whole step to the second slope instead of half a step", [](P& p) { stage(p, 2, 1); }},
      {"stage_fraction", 4, "goes whole steps to the second and third slopes instead of half steps", [](P& p) { stage(p, 2, 1); stage(p, 3, 0, 1); }},
      {"stage_fraction", 4, "goes quarter steps to the second and third slopes instead of half steps", [](P& p) { stage(p, 2, 0.25); stage(p, 3, 0, 0.25); }},
      {"in_place", kAny, "overwrites particle by particle: forces on later particles use the new positions and velocities of earlier ones", [](P& p) { p.order = Order::kStagesInPlace; }},
      {"in_place", kAny, "overwrites the positions particle by particle: forces on later particles use the new positions of earlier ones", [](P& p) { p.order = Order::kPositionsInPlace; }},
      {"in_place", kSeveral, "takes the whole step of a particle before the next particle, which uses the result", [](P& p) { p.order = Order::kParticlesInPlace; }},
      {"frozen_neighbours", kSeveral, "keeps the neighbours of a particle where they were at the begin of the step in all its stages", [](P& p) { p.order = Order::kFrozenNeighbours; }},
      // The force
      {"no_damping", kAny, "leaves out the damping", [](P& p) { p.damping = 0; }},
      {"damping_sign", kAny, "has the wrong sign of the damping", [](P& p) { p.damping = -p.damping; }},
      {"damping_not_projected", kAny, "damps the whole relative velocity instead of its part along the spring", [](P& p) { p.damping_kind = Damping::kWhole; }},
      {"damping_own_velocity", kAny, "damps the velocity of the particle instead of the relative velocity of both ends", [](P& p) { p.damping_kind = Damping::kOwn; }},
      {"damping_not_unit", kAny, "projects the relative velocity on p_j - p_i instead of the unit vector r", [](P& p) { p.damping_kind = Damping::kNotUnit; }},
      {"damping_absolute", kAny, "takes the absolute value of the damping", [](P& p) { p.damping_kind = Damping::kAbsolute; }},
      {"direction_not_unit", kAny, "multiplies the force by p_j - p_i instead of the unit vector r", [](P& p) { p.direction = Direction::kSeparation; }},
      {"degrees", kAny, "gives cos and sin an angle in degrees", [](P& p) { p.direction = Direction::kDegrees; }},
      {"degrees", kAny, "gives cos and sin an angle in degrees", [](P& p) { p.direction = Direction::kDegreesOfSpring; }},
      {"length_integer", kAny, "cuts the length of a spring to an integer", [](P& p) { p.length = Length::kInteger; }},
      {"length_squared", kAny, "takes the square of the length as elongation: the root is missing", [](P& p) { p.length = Length::kSquared; }},
      {"length_squared", kAny, "takes the square of the length for the length: the root is missing", [](P& p) { p.length = Length::kSquaredEverywhere; }},
      {"mass_not_divided", kAny, "does not divide the force by the mass", [](P& p) { p.force_mass_power = 0; }},
      {"mass_not_divided", kAny, "multiplies the force by the mass instead of dividing", [](P& p) { p.force_mass_power = 1; }},
      {"mass_of_neighbour", kAny, "divides the force by the mass of the previous particle", [](P& p) { p.mass_of = -1; }},
      {"mass_of_neighbour", kAny, "divides the force by the mass of the next particle", [](P& p) { p.mass_of = 1; }},
      {"gravity_divided", kAny, "divides gravity by the mass: g is an acceleration", [](P& p) { p.gravity_mass_power = -1; }},
      {"gravity_multiplied", kAny, "multiplies the acceleration g by the mass", [](P& p) { p.gravity_mass_power = 1; }},
      {"force_sign", kAny, "has the wrong sign of the spring force", [](P& p) { p.left = p.right = -1; }},
      {"spring_sign", kAny, "has the wrong sign of the spring force, but not of its damping", [](P& p) { p.stiffness = -p.stiffness; }},
      {"one_spring", kAny, "uses only the spring to the previous particle", [](P& p) { p.right = 0; }},
      {"one_spring", kAny, "uses only the spring to the next particle", [](P& p) { p.left = 0; }},
      {"reaction_sign", kAny, "has the wrong sign of the force of the spring to the next particle", [](P& p) { p.right = -1; }},
      {"reaction_sign", kAny, "has the wrong sign of the force of the spring to the previous particle", [](P& p) { p.left = -1; }},
      {"last_spring", kAny, "leaves out the spring to the last particle", [](P& p) { p.springs = Springs::kAllButLast; }},
      {"every_second_spring", kAny, "uses only every second spring", [](P& p) { p.springs = Springs::kEverySecond; }},
      {"no_spring", kAny, "leaves out the springs", [](P& p) { p.left = p.right = 0; }},
      {"start_length", kAny, "takes the distance at the start as rest length of each spring", [](P& p) { p.rest_length_from_start = true; }},
      {"first_moves", kAny, "moves the first particle, which is fixed", [](P& p) { p.first_moves = true; }},
      {"last_fixed", kAny, "does not move the last particle", [](P& p) { p.last_moves = false; }},
      {"gravity_9.8", kAny, "uses g = 9.8 m/s²", [](P& p) { p.gravity = 9.8; }},
      {"gravity_10", kAny, "uses g = 10 m/s²", [](P& p) { p.gravity = 10; }},
      {"gravity_up", kAny, "lets gravity point up", [](P& p) { p.gravity = -p.gravity; }},
      {"gravity_x", kAny, "lets gravity act along x", [](P& p) { std::swap(p.gravity, p.gravity_x); }},
      {"gravity_on_last", kAny, "lets gravity act on the last particle only", [](P& p) { p.gravity_on_last_only = true; }},
      {"no_gravity", kAny, "leaves out gravity", [](P& p) { p.gravity = 0; }},
      // The loop and the files
      {"no_motion", kAny, "moves nothing: all frames are the start (in integers 1 / 2 and 1 / 6 are 0)", [](P& p) { p.time_step = 0; }},
      {"steps_per_frame", kAny, "takes 1 step fewer per frame", [](P& p) { p.steps_per_frame -= 1; }},
      {"steps_per_frame", kAny, "takes 1 step more per frame", [](P& p) { p.steps_per_frame += 1; }},
      {"steps_per_frame", kAny, "writes a frame after every step", [](P& p) { p.steps_per_frame = 1; }},
      {"frame_shift", kAny, "leaves out the start: each frame is one too late", [](P& p) { p.first_step = p.steps_per_frame; }},
      {"frame_shift", kAny, "numbers the frames from 1, or writes the start twice: each frame is one too early", [](P& p) { p.first_step = -p.steps_per_frame; }},
      {"step_shift", kAny, "writes each frame one step too late", [](P& p) { p.first_step = 1; }},
      {"step_shift", kAny, "writes each frame one step too early", [](P& p) { p.first_step = -1; }},
      {"time_step", kAny, "uses a time step ten times as long", [](P& p) { p.time_step *= 10; }},
      {"time_step", kAny, "takes one step per frame, as long as all together", [](P& p) { p.time_step *= static_cast<double>(p.steps_per_frame); p.steps_per_frame = 1; }},
      {"time_step", kAny, "uses a tenth of the time step", [](P& p) { p.time_step /= 10; }},
      {"time_step", kAny, "takes ten times as many steps, each a tenth as long", [](P& p) { p.time_step /= 10; p.steps_per_frame *= 10; }},
      {"swapped", kAny, "writes y before x", [](P& p) { p.swaps_columns = true; }},
      {"reversed", kAny, "writes the particles in reverse order", [](P& p) { p.reverses_particles = true; }},
      {"single_precision", kAny, "computes with float instead of double", [](P& p) { p.single_precision = true; }},
  };
  return kTable;
}

const std::vector<Constant>& fittedConstants() {
  static const std::vector<Constant> kTable = {
      {"k_s", "uses the spring constant k_s = {} N/m", &P::stiffness},
      {"k_d", "uses the damping constant k_d = {} N·s/m", &P::damping},
      {"L_0", "uses the rest length L_0 = {} m", &P::rest_length},
      {"g", "uses g = {} m/s²", &P::gravity},
      {"time_step", "uses a time step of {} s", &P::time_step},
  };
  return kTable;
}
// clang-format on

}  // namespace spring_pendulum
