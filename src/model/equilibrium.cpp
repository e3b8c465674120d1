#include "base/checks.hpp"
#include <spring_pendulum/model/dynamics.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

using Vector = PlaneVector<double>;

constexpr int kMostIterations = 200;
constexpr double kShortest = 1e-12;  ///< shortest part of a Newton step
/// Largest remaining force on a particle, relative to the sum of the magnitudes of the forces on it.
constexpr double kMostUnbalanced = 1e-6;

Vector operator+(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y};
}
Vector operator*(double factor, const Vector& a) {
  return {factor * a.x, factor * a.y};
}

/// Force of gravity and the drive on a particle, N.
Vector loadOn(const Chain& chain, Eigen::Index i) {
  return chain.masses()[i] * chain.springlessAcceleration(i);
}

/// Returns the separation of the ends of a spring that pulls its left end with the force f. Without
/// force it points down.
Vector separationAt(const SpringLaw& spring, const Vector& f) {
  const double force = lengthOf(f);
  if (force == 0.0) return {0.0, -spring.rest_length};
  return (spring.rest_length / force + 1.0 / spring.stiffness) * f;
}

/// The springs between two held particles.
class Segment {
 public:
  Segment(const Chain& chain, Eigen::Index first, Eigen::Index last, const Vector& span)
      : chain_(chain), first_(first), last_(last), span_(span) {}

  /// Complementary energy of the force of the first spring, J, with gradient and Hessian.
  struct Energy {
    double value = 0.0;
    Vector gradient{};
    double xx = 0.0, xy = 0.0, yy = 0.0;

    double unbalanced() const { return lengthOf(gradient); }
    Vector newtonStep() const {
      const double determinant = xx * yy - xy * xy;
      return {(xy * gradient.y - yy * gradient.x) / determinant,
              (xy * gradient.x - xx * gradient.y) / determinant};
    }
  };

  Energy energyOf(const Vector& first_force) const {
    const SpringLaw& spring = chain_.spring();
    Energy energy;
    energy.value = -(first_force.x * span_.x + first_force.y * span_.y);
    energy.gradient = -1.0 * span_;
    Vector f = first_force;
    for (Eigen::Index i = first_; i < last_; ++i) {
      if (i > first_) f = f + -1.0 * loadOn(chain_, i);
      const double force = std::max(lengthOf(f), std::numeric_limits<double>::min());
      const Vector r = (1.0 / force) * f;
      const double turn = spring.rest_length / force, stretch = 1.0 / spring.stiffness;
      energy.value += force * (spring.rest_length + 0.5 * force * stretch);
      energy.gradient = energy.gradient + (turn + stretch) * f;
      energy.xx += turn * r.y * r.y + stretch;
      energy.xy -= turn * r.x * r.y;
      energy.yy += turn * r.x * r.x + stretch;
    }
    return energy;
  }

  /// Returns the force of the first spring in equilibrium: the minimum.
  Vector solve() const {
    Vector f{};
    for (Eigen::Index i = first_ + 1; i < last_; ++i) f = f + 0.5 * loadOn(chain_, i);
    const double pull = lengthOf(f) + chain_.spring().stiffness * chain_.spring().rest_length;
    f = f + (0.1 * pull / std::max(lengthOf(span_), 1e-9)) * span_;
    double length = 1.0;
    for (int i = 0; i < kMostIterations && length > kShortest; ++i) {
      const Energy energy = energyOf(f);
      const Vector step = energy.newtonStep();
      const double slope = step.x * energy.gradient.x + step.y * energy.gradient.y;
      length = 1.0;
      while (length > kShortest &&
             !(energyOf(f + length * step).value <= energy.value + 1e-4 * length * slope)) {
        length *= 0.5;
      }
      if (length > kShortest) f = f + length * step;
    }
    // The energy no longer resolves the minimum, but its gradient does.
    for (Energy energy = energyOf(f);;) {
      const Vector better = f + energy.newtonStep();
      const Energy next = energyOf(better);
      if (!(next.unbalanced() < energy.unbalanced())) return f;
      f = better;
      energy = next;
    }
  }

 private:
  const Chain& chain_;
  Eigen::Index first_, last_;
  Vector span_;
};

/// Whether a spring has no length, and so no direction.
bool hasShrunkSpring(const State& state) {
  for (Eigen::Index i = 0; i + 1 < state.size(); ++i) {
    if (state.x()[i] == state.x()[i + 1] && state.y()[i] == state.y()[i + 1]) return true;
  }
  return false;
}

/// Whether gravity, forces and springs balance on each particle that is not held.
bool isBalanced(const Chain& chain, const State& state) {
  Vector left{};
  for (Eigen::Index i = 0; i < chain.size(); ++i) {
    const Vector right = i + 1 < chain.size() ? springForceOn(chain, state, i) : Vector{};
    const Vector load = loadOn(chain, i);
    const Vector sum = right + -1.0 * left + load;
    const double all = std::abs(right.x) + std::abs(right.y) + std::abs(left.x) + std::abs(left.y) +
                       std::abs(load.x) + std::abs(load.y);
    const double rounding =
        1e-13 * chain.spring().stiffness *
        (std::abs(state.x()[i]) + std::abs(state.y()[i]) + chain.spring().rest_length);
    const double unbalanced = std::abs(sum.x) + std::abs(sum.y);
    if (!chain.isHeld(i) && !(unbalanced <= kMostUnbalanced * all + rounding)) return false;
    left = right;
  }
  return true;
}

}  // namespace

State equilibrium(const Chain& chain, const State& state) {
  requireSize(chain.size(), state.size());
  const SpringLaw& spring = chain.spring();
  if (chain.size() > 1 && spring.stiffness == 0.0) {
    throw InputError("a chain at rest needs a stiffness above 0 N/m");
  }
  State result = state;
  result.velocities().setZero();
  const auto hang = [&](Eigen::Index first, Eigen::Index end, Vector force) {
    for (Eigen::Index i = first + 1; i < end; ++i) {
      const Vector separation = separationAt(spring, force);
      result.x()[i] = result.x()[i - 1] + separation.x;
      result.y()[i] = result.y()[i - 1] + separation.y;
      force = force + -1.0 * loadOn(chain, i);
    }
  };
  Eigen::Index first = 0;
  for (Eigen::Index last = 1; last < chain.size(); ++last) {
    if (!chain.isHeld(last)) continue;
    const Vector span{state.x()[last] - state.x()[first], state.y()[last] - state.y()[first]};
    if (last > first + 1) hang(first, last, Segment(chain, first, last, span).solve());
    first = last;
  }
  Vector weight{};
  for (Eigen::Index i = first + 1; i < chain.size(); ++i) weight = weight + loadOn(chain, i);
  hang(first, chain.size(), weight);
  if (hasShrunkSpring(result)) {
    throw InputError(
        "a chain at rest with a spring of length 0 cannot move on: give it a rest length, gravity, "
        "or held particles that are apart");
  }
  if (!result.values().allFinite()) {
    throw InputError(
        "the chain at rest is longer than a double can hold: the stiffness must be larger");
  }
  if (!isBalanced(chain, result)) {
    throw InputError(
        "found no rest position of the chain in which all springs are stretched: move its held "
        "particles apart");
  }
  return result;
}

}  // namespace spring_pendulum
