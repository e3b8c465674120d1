// A program that a student may have written, the known mistakes in it, and its numbers that may be wrong.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {

/// The force of a spring on a particle, as a program computes it:
///
///     stiffness (length - rest_length) direction + damping damped
struct StudentSpring {
  Eigen::Array2d separation;         ///< from the particle to its neighbour, m
  Eigen::Array2d relative_velocity;  ///< of the neighbour, m/s
  Eigen::Array2d velocity;           ///< of the particle, m/s
  bool to_previous;                  ///< whether the neighbour is the previous particle
  double start_length, rest_length;  ///< m
  double length;                     ///< m
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
  double left = 1.0;
  double right = 1.0;
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
  enum Kind : unsigned {
    kEuler = 1,
    kMidpoint = 2,
    kHeun = 4,
    kRungeKutta4 = 8,
    kOtherTableau = 16,
    kSymplectic = 32,
    kImplicit = 64
  };
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
  bool single_precision = false;
  /// Changes of a spring, of a particle, of a way, and of the numbers that are printed.
  std::vector<void (*)(StudentSpring&)> springs = {};
  std::vector<void (*)(StudentParticle&)> particles = {};
  std::vector<void (*)(StudentMove&)> moves = {};
  std::vector<void (*)(Eigen::Array4Xd&)> prints = {};
  /// Short names of the mistakes that were made, "heun" or "g", and for each a sentence for the student.
  std::vector<std::string> mistakes = {}, sentences = {};

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

}  // namespace spring_pendulum
