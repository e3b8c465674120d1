// One line per mistake, the likeliest first: the first that reproduces the frames is reported first.
#include "check/motion.hpp"

#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

using P = StudentProgram;
using Spring = StudentSpring;
using Particle = StudentParticle;
using Move = StudentMove;
using Numbers = Eigen::Array4Xd;
using Order = P::Order;

constexpr unsigned kTwo = P::kMidpoint | P::kHeun;
constexpr unsigned kFour = P::kRungeKutta4;
constexpr unsigned kSeveral = kTwo | kFour | P::kOtherTableau;
constexpr unsigned kExplicit = P::kEuler | kSeveral;
constexpr unsigned kAny = kExplicit | P::kSymplectic | P::kImplicit;

/// Row i of the tableau: the stage, counted from 1, starts with these slopes.
void stage(P& p, std::size_t i, double a, double b = 0.0, double c = 0.0) {
  p.tableau.a.at(i - 1) = {a, b, c};
}

void weights(P& p, double a, double b, double c = 0.0, double d = 0.0) {
  p.tableau.b = {a, b, c, d};
}

/// The direction that cos and sin give for the angle in degrees.
Eigen::Array2d inDegrees(const Eigen::Array2d& d) {
  constexpr double kDegrees = 57.295779513082320877;
  const double angle = kDegrees * std::atan2(d.y(), d.x());
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

unsigned kindOf(const Method& method) {
  if (method.name == "Backward-Euler") return P::kImplicit;
  if (method.name == "Semi-Implicit-Euler") return P::kSymplectic;
  if (!method.hasFixedStep() || method.tableau == nullptr) return 0;
  const ButcherTableau& tableau = *method.tableau;
  if (tableau.stages == 1) return P::kEuler;
  if (method.name == "Runge-Kutta-4") return P::kRungeKutta4;
  if (tableau.stages != 2) return P::kOtherTableau;
  return tableau.b[0] == 0.0 ? P::kMidpoint : tableau.a[1][0] == 1.0 ? P::kHeun : P::kOtherTableau;
}

StudentProgram::StudentProgram(const Method& wanted, const Scenario& scenario)
    : Plan(scenario),
      Constants(scenario.constants),
      kinds(kindOf(wanted)),
      tableau(wanted.tableau != nullptr ? *wanted.tableau : kEulerTableau) {
  method = wanted;
  if (wanted.symplectic) moves.push_back([](Move& m) { m.moveWith(m.result.tail<2>()); });
}

bool StudentProgram::canMake(const Mistake& mistake) const {
  return (mistake.kinds & kinds) != 0 && (mistakes.empty() || mistakes.back() != mistake.name);
}

StudentProgram StudentProgram::with(const Mistake& mistake) const {
  StudentProgram other = *this;
  mistake.make(other);
  other.mistakes.emplace_back(mistake.name);
  other.sentences.emplace_back(mistake.sentence);
  return other;
}

// clang-format off
// NOLINTNEXTLINE(readability-function-size): data
const std::vector<Mistake>& knownMistakes() {
  static const std::vector<Mistake> kTable = {
      // The method
      {"heun", P::kMidpoint, "averages the slopes at both ends of the step (Heun) instead of taking the one in the middle", [](P& p) { stage(p, 2, 1); weights(p, 0.5, 0.5); }},
      {"stage_fraction", P::kHeun, "goes half a step to its second slope instead of a whole one", [](P& p) { stage(p, 2, 0.5); }},
      {"weights", P::kHeun, "takes only the slope at the end of the step", [](P& p) { weights(p, 0, 1); }},
      {"half_square", P::kEuler, "adds h²/2 times the acceleration to the positions", [](P& p) { p.moves.push_back([](Move& m) { m.result.head<2>() += 0.5 * m.step * (m.result - m.start).tail<2>(); }); }},
      {"one_iteration", P::kImplicit, "solves one linear system per step instead of iterating until the equation holds", [](P& p) { p.is_linearised = true; }},
      {"semi_implicit", kExplicit, "moves the positions with the velocities that are already updated (semi-implicit)", [](P& p) { p.moves.push_back([](Move& m) { if (m.ends_step) m.moveWith(m.result.tail<2>()); }); }},
      {"semi_implicit_stages", kSeveral, "moves the positions of a stage with the velocities of the same stage", [](P& p) { p.moves.push_back([](Move& m) { if (!m.ends_step) m.moveWith(m.result.tail<2>()); }); }},
      {"semi_implicit_stages", kSeveral, "moves the positions with the velocities already updated, in stages and at the end of the step", [](P& p) { p.moves.push_back([](Move& m) { m.moveWith(m.result.tail<2>()); }); }},
      {"semi_implicit_stages", kSeveral, "takes v + h a, the velocity already updated, as slope of the positions", [](P& p) { p.moves.push_back([](Move& m) { m.result.head<2>() += m.step * (m.result - m.start).tail<2>(); }); }},
      {"force_after_move", P::kEuler, "computes the forces after it has moved the positions", [](P& p) { p.order = Order::kForceAfterMove; }},
      {"old_velocity", kSeveral, "moves the positions with the velocity at the begin of the step, as Euler does", [](P& p) { p.moves.push_back([](Move& m) { if (m.ends_step) m.moveWith(m.start.tail<2>()); }); }},
      {"old_force", kSeveral, "changes the velocities with the force at the begin of the step, as Euler does", [](P& p) { p.moves.push_back([](Move& m) { if (m.ends_step) m.result.tail<2>() = (m.start + m.step * m.first_slope).tail<2>(); }); }},
      {"stage_velocity", kSeveral, "does not change the velocities in the stages, only the positions", [](P& p) { p.moves.push_back([](Move& m) { if (!m.ends_step) m.result.tail<2>() = m.start.tail<2>(); }); }},
      {"stage_position", kSeveral, "does not change the positions in the stages, only the velocities", [](P& p) { p.moves.push_back([](Move& m) { if (!m.ends_step) m.result.head<2>() = m.start.head<2>(); }); }},
      {"stage_fraction", P::kMidpoint, "goes a whole step to its second slope instead of half a step", [](P& p) { stage(p, 2, 1); }},
      {"stage_slope", P::kMidpoint, "starts the step with the second slope from the middle instead of the begin of the step", [](P& p) { weights(p, 0.5, 1); }},
      {"weights", kTwo, "adds both slopes without halving the sum", [](P& p) { weights(p, 1, 1); }},
      {"weights", P::kMidpoint, "takes the mean of the first slope and the one in the middle", [](P& p) { weights(p, 0.5, 0.5); }},
      {"weights", kFour, "weights the slopes 1, 1, 1, 1 (over 4) instead of 1, 2, 2, 1 (over 6)", [](P& p) { weights(p, 1.0 / 4, 1.0 / 4, 1.0 / 4, 1.0 / 4); }},
      {"weights", kFour, "weights the slopes 1, 1, 1, 1 (over 6) instead of 1, 2, 2, 1 (over 6)", [](P& p) { weights(p, 1.0 / 6, 1.0 / 6, 1.0 / 6, 1.0 / 6); }},
      {"weights", kFour, "weights the slopes 1, 1, 2, 2 (over 6) instead of 1, 2, 2, 1 (over 6)", [](P& p) { weights(p, 1.0 / 6, 1.0 / 6, 2.0 / 6, 2.0 / 6); }},
      {"three_eighths", kFour, "uses the 3/8 rule, another method of fourth order", [](P& p) { stage(p, 2, 1.0 / 3); stage(p, 3, -1.0 / 3, 1); stage(p, 4, 1, -1, 1); weights(p, 1.0 / 8, 3.0 / 8, 3.0 / 8, 1.0 / 8); }},
      {"stage_slope", kFour, "starts the third stage with the first slope instead of the second", [](P& p) { stage(p, 3, 0.5); }},
      {"stage_slope", kFour, "starts the fourth stage with the second slope instead of the third", [](P& p) { stage(p, 4, 0, 1); }},
      {"stage_slope", kFour, "starts the fourth stage with the first slope instead of the third", [](P& p) { stage(p, 4, 1); }},
      {"stage_slope", kFour, "starts all stages with the first slope", [](P& p) { stage(p, 3, 0.5); stage(p, 4, 1); }},
      {"stage_slope", kFour, "starts the third and fourth stages from the stage before instead of the begin of the step", [](P& p) { stage(p, 3, 0.5, 0.5); stage(p, 4, 0.5, 0.5, 1); }},
      {"stage_slope", kFour, "starts the third stage from the second instead of the begin of the step", [](P& p) { stage(p, 3, 0.5, 0.5); }},
      {"stage_slope", kFour, "computes the second slope at the begin of the step", [](P& p) { stage(p, 2, 0); }},
      {"stage_slope", kFour, "computes the second and third slopes at the begin of the step (in integers 1 / 2 is 0)", [](P& p) { stage(p, 2, 0); stage(p, 3, 0); }},
      {"stage_fraction", kFour, "goes half a step to the fourth slope instead of a whole one", [](P& p) { stage(p, 4, 0, 0, 0.5); }},
      {"stage_fraction", kFour, "goes a whole step to the third slope instead of half a step", [](P& p) { stage(p, 3, 0, 1); }},
      {"stage_fraction", kFour, "goes a whole step to the second slope instead of half a step", [](P& p) { stage(p, 2, 1); }},
      {"in_place", kExplicit, "overwrites particle by particle: forces on later particles use the new positions and velocities of earlier ones", [](P& p) { p.order = Order::kStagesInPlace; }},
      {"in_place", kExplicit, "overwrites the positions particle by particle: forces on later particles use the new positions of earlier ones", [](P& p) { p.order = Order::kPositionsInPlace; }},
      {"in_place", kSeveral, "takes the whole step of a particle before the next particle, which uses the result", [](P& p) { p.order = Order::kParticlesInPlace; }},
      // The force
      {"no_damping", kAny, "leaves out the damping", [](P& p) { p.spring.damping = 0; }},
      {"damping_sign", kAny, "has the wrong sign of the damping", [](P& p) { p.spring.damping = -p.spring.damping; }},
      {"direction_not_unit", kAny, "multiplies the force by p_j - p_i instead of the unit vector r", [](P& p) { p.springs.push_back([](Spring& s) { s.direction *= s.length; s.damped *= s.length; }); }},
      {"degrees", kAny, "gives cos and sin an angle in degrees", [](P& p) { p.springs.push_back([](Spring& s) { s.pointTo(inDegrees(s.separation)); }); }},
      {"degrees", kAny, "gives cos and sin an angle in degrees", [](P& p) { p.springs.push_back([](Spring& s) { s.pointTo(s.to_previous ? Eigen::Array2d(-inDegrees(-s.separation)) : inDegrees(s.separation)); }); }},
      {"length_integer", kAny, "cuts the length of a spring to an integer", [](P& p) { p.springs.push_back([](Spring& s) { s.length = std::trunc(s.length); }); }},
      {"length_squared", kAny, "takes the square of the length as elongation: the root is missing", [](P& p) { p.springs.push_back([](Spring& s) { s.length *= s.length; }); }},
      {"length_squared", kAny, "takes the square of the length for the length: the root is missing", [](P& p) { p.springs.push_back([](Spring& s) { s.length *= s.length; s.pointTo(s.separation / s.length); }); }},
      {"damping_not_projected", kAny, "damps the whole relative velocity instead of its part along the spring", [](P& p) { p.springs.push_back([](Spring& s) { s.damped = s.relative_velocity; }); }},
      {"damping_own_velocity", kAny, "damps the velocity of the particle instead of the relative velocity of both ends", [](P& p) { p.springs.push_back([](Spring& s) { s.damped = -s.velocity; }); }},
      {"damping_not_unit", kAny, "projects the relative velocity on p_j - p_i instead of the unit vector r", [](P& p) { p.springs.push_back([](Spring& s) { s.damped = (s.relative_velocity * s.separation).sum() * s.direction; }); }},
      {"damping_absolute", kAny, "takes the absolute value of the damping", [](P& p) { p.springs.push_back([](Spring& s) { if ((s.relative_velocity * s.separation).sum() < 0) s.damped = -s.damped; }); }},
      {"mass_not_divided", kAny, "does not divide the force by the mass", [](P& p) { p.particles.push_back([](Particle& a) { a.divisor = 1; }); }},
      {"mass_not_divided", kAny, "multiplies the force by the mass instead of dividing", [](P& p) { p.particles.push_back([](Particle& a) { a.divisor = 1 / a.mass; }); }},
      {"mass_of_neighbour", kAny, "divides the force by the mass of the previous particle", [](P& p) { p.particles.push_back([](Particle& a) { a.divisor = a.previous_mass; }); }},
      {"mass_of_neighbour", kAny, "divides the force by the mass of the next particle", [](P& p) { p.particles.push_back([](Particle& a) { a.divisor = a.next_mass; }); }},
      {"gravity_divided", kAny, "divides gravity by the mass: g is an acceleration", [](P& p) { p.particles.push_back([](Particle& a) { a.gravity /= a.mass; }); }},
      {"gravity_multiplied", kAny, "multiplies the acceleration g by the mass", [](P& p) { p.particles.push_back([](Particle& a) { a.gravity *= a.mass; }); }},
      {"force_sign", kAny, "has the wrong sign of the spring force", [](P& p) { p.particles.push_back([](Particle& a) { a.left = a.right = -1; }); }},
      {"spring_sign", kAny, "has the wrong sign of the spring force, but not of its damping", [](P& p) { p.spring.stiffness = -p.spring.stiffness; }},
      {"one_spring", kAny, "uses only the spring to the previous particle", [](P& p) { p.particles.push_back([](Particle& a) { a.right = 0; }); }},
      {"one_spring", kAny, "uses only the spring to the next particle", [](P& p) { p.particles.push_back([](Particle& a) { a.left = 0; }); }},
      {"reaction_sign", kAny, "has the wrong sign of the force of the spring to the next particle", [](P& p) { p.particles.push_back([](Particle& a) { a.right = -a.right; }); }},
      {"reaction_sign", kAny, "has the wrong sign of the force of the spring to the previous particle", [](P& p) { p.particles.push_back([](Particle& a) { a.left = -a.left; }); }},
      {"last_spring", kAny, "leaves out the spring to the last particle", [](P& p) { p.particles.push_back([](Particle& a) { if (a.index == a.last) a.left = 0; if (a.index + 1 == a.last) a.right = 0; }); }},
      {"last_spring", kAny, "leaves out the force of the last particle on the one before", [](P& p) { p.particles.push_back([](Particle& a) { if (a.index + 1 == a.last) a.right = 0; }); }},
      {"every_second_spring", kAny, "uses only every second spring", [](P& p) { p.particles.push_back([](Particle& a) { (a.index % 2 == 0 ? a.left : a.right) = 0; }); }},
      {"first_spring", kAny, "leaves out the spring to the first particle", [](P& p) { p.particles.push_back([](Particle& a) { if (a.index == 1) a.left = 0; if (a.index == 0) a.right = 0; }); }},
      {"springs_twice", kAny, "adds the force of each spring twice", [](P& p) { p.particles.push_back([](Particle& a) { a.left *= 2; a.right *= 2; }); }},
      {"springs_half", kAny, "takes half of the force of each spring", [](P& p) { p.particles.push_back([](Particle& a) { a.left /= 2; a.right /= 2; }); }},
      {"only_tension", kAny, "lets the springs pull only, not push", [](P& p) { p.springs.push_back([](Spring& s) { s.length = std::max(s.length, s.rest_length); }); }},
      {"no_spring", kAny, "leaves out the springs", [](P& p) { p.particles.push_back([](Particle& a) { a.left = a.right = 0; }); }},
      {"start_length", kAny, "takes the distance at the start as rest length of each spring", [](P& p) { p.springs.push_back([](Spring& s) { s.rest_length = s.start_length; }); }},
      {"first_moves", kAny, "moves the first particle, which is fixed", [](P& p) { p.particles.push_back([](Particle& a) { a.moves = true; }); }},
      {"last_fixed", kAny, "does not move the last particle", [](P& p) { p.particles.push_back([](Particle& a) { if (a.index == a.last) a.moves = false; }); }},
      {"gravity_9.8", kAny, "uses g = 9.8 m/s²", [](P& p) { p.gravity = 9.8; }},
      {"gravity_10", kAny, "uses g = 10 m/s²", [](P& p) { p.gravity = 10; }},
      {"gravity_up", kAny, "lets gravity point up", [](P& p) { p.gravity = -p.gravity; }},
      {"gravity_on_last", kAny, "lets gravity act on the last particle only", [](P& p) { p.particles.push_back([](Particle& a) { if (a.index < a.last) a.gravity.setZero(); }); }},
      {"no_gravity", kAny, "leaves out gravity", [](P& p) { p.gravity = 0; }},
      {"gravity_twice", kAny, "adds gravity once for each spring of a particle", [](P& p) { p.particles.push_back([](Particle& a) { if (a.index > 0 && a.index < a.last) a.gravity *= 2; }); }},
      {"no_air_drag", kAny, "leaves out the air drag", [](P& p) { p.air_drag = 0; }},
      {"air_drag_sign", kAny, "has the wrong sign of the air drag", [](P& p) { p.air_drag = -p.air_drag; }},
      {"air_drag_not_divided", kAny, "does not divide the air drag by the mass", [](P& p) { p.particles.push_back([](Particle& a) { a.drag *= a.divisor; }); }},
      {"air_drag_squared", kAny, "lets the air drag grow with the square of the speed", [](P& p) { p.particles.push_back([](Particle& a) { a.drag_power = 1; }); }},
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
      {"time_step", kAny, "takes twice as many steps, each half as long", [](P& p) { p.time_step /= 2; p.steps_per_frame *= 2; }},
      {"time_step", kAny, "takes half as many steps, each twice as long", [](P& p) { p.time_step *= 2; p.steps_per_frame /= 2; }},
      {"swapped", kAny, "writes y before x", [](P& p) { p.prints.push_back([](Numbers& z) { z.row(0).swap(z.row(1)); }); }},
      {"y_down", kAny, "writes -y instead of y", [](P& p) { p.prints.push_back([](Numbers& z) { z.row(1) *= -1; }); }},
      {"reversed", kAny, "writes the particles in reverse order", [](P& p) { p.prints.push_back([](Numbers& z) { z = z.rowwise().reverse().eval(); }); }},
      {"velocities", kAny, "writes the velocities instead of the positions", [](P& p) { p.prints.push_back([](Numbers& z) { z.topRows<2>() = z.bottomRows<2>().eval(); }); }},
      {"single_precision", 0, "computes with float instead of double", [](P& p) { p.single_precision = true; }},
  };
  return kTable;
}

const std::vector<Constant>& fittedConstants() {
  static const std::vector<Constant> kTable = {
      {"k_s", "uses the spring constant k_s = {} N/m", [](P& p) -> double& { return p.spring.stiffness; }},
      {"k_d", "uses the damping constant k_d = {} N·s/m", [](P& p) -> double& { return p.spring.damping; }},
      {"L_0", "uses the rest length L_0 = {} m", [](P& p) -> double& { return p.spring.rest_length; }},
      {"g", "uses g = {} m/s²", [](P& p) -> double& { return p.gravity; }},
      {"air_drag", "has an air drag of {} N·s/m", [](P& p) -> double& { return p.air_drag; }},
      {"time_step", "uses a time step of {} s", [](P& p) -> double& { return p.time_step; }},
  };
  return kTable;
}
// clang-format on

}  // namespace spring_pendulum
