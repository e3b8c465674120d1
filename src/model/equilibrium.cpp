#include "base/checks.hpp"
#include <spring_pendulum/model/dynamics.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

using Vector = Eigen::Vector2d;

constexpr int kMostIterations = 200;
constexpr double kShortest = 1e-12;  ///< least part of a Newton step
constexpr double kSharp = 1e-14;     ///< least blur above 0, relative to the first one
constexpr double kClosed = 1e-11;  ///< largest remaining gap, relative to the length of the springs

/// Force of gravity and the drive on a particle, N.
Vector loadOn(const Chain& chain, Eigen::Index i) {
  const auto [x, y] = chain.springlessAcceleration(i);
  return chain.masses()[i] * Vector(x, y);
}

double norm(const Vector& v) {
  return lengthOf({v.x(), v.y()});
}

/// Returns the separation of the ends of a spring that pulls its left end with the force f. Without
/// force it points down.
Vector separationAt(const SpringLaw& spring, const Vector& f) {
  const double force = norm(f);
  if (force == 0.0) return {0.0, -spring.rest_length};
  return (spring.rest_length / force + 1.0 / spring.stiffness) * f;
}

/// Where the springs between two held particles end if the first one has a given force. The direction of
/// a spring changes within `blur`, in N, where its force turns over; without blur, suddenly.
struct Gap {
  double length;       ///< from the second held particle to the end of the last spring, m
  double springs;      ///< length of the springs, m
  Vector newton_step;  ///< change of the force that would close the gap if it were linear, N
};

Gap gapOf(const Chain& chain, Eigen::Index first, Eigen::Index last, const Vector& span, Vector f,
          double blur) {
  Vector gap = -span;
  double springs = 0.0;
  double xx = 0.0, xy = 0.0, yy = 0.0;  // derivative by the force, m/N: the Hessian of the energy
  for (Eigen::Index i = first; i < last; ++i) {
    if (i > first) f -= loadOn(chain, i);
    const double force = std::max(std::sqrt(f.x() * f.x() + f.y() * f.y() + blur * blur),
                                  std::numeric_limits<double>::min());
    const Vector r = (1.0 / force) * f;
    const double rest = blur / force * (blur / force);  // 1 - r·r
    const double turn = chain.spring().rest_length / force;
    const double stretch = 1.0 / chain.spring().stiffness;
    gap += (turn + stretch) * f;
    springs += chain.spring().rest_length + stretch * force;
    xx += turn * (r.y() * r.y() + rest) + stretch;
    xy -= turn * r.x() * r.y();
    yy += turn * (r.x() * r.x() + rest) + stretch;
  }
  const Vector step(xy * gap.y() - yy * gap.x(), xy * gap.x() - xx * gap.y());
  return {norm(gap), springs, step / (xx * yy - xy * xy)};
}

/// Returns the force of the first spring in equilibrium, where the gap is closed.
Vector firstForce(const Chain& chain, Eigen::Index first, Eigen::Index last, const Vector& span) {
  Vector f = Vector::Zero();
  for (Eigen::Index i = first + 1; i < last; ++i) f += 0.5 * loadOn(chain, i);
  const double pull = norm(f) + chain.spring().stiffness * chain.spring().rest_length;
  f += (0.1 * pull / std::max(norm(span), 1e-9)) * span;
  // Without blur, the iteration would stop where a spring turns over.
  double blur = pull;
  Gap gap = gapOf(chain, first, last, span, f, blur);
  for (int i = 0; i < kMostIterations; ++i) {
    // Along a Newton step, the length of the gap decreases at first.
    double part = 1.0;
    Gap next = gapOf(chain, first, last, span, f + gap.newton_step, blur);
    while (part > kShortest && !(next.length < gap.length)) {
      part *= 0.5;
      next = gapOf(chain, first, last, span, f + part * gap.newton_step, blur);
    }
    if (part <= kShortest && blur == 0.0) break;
    f += part * gap.newton_step;
    const double sharper = blur > kSharp * pull ? 0.5 * blur : 0.0;
    gap = sharper == blur ? next : gapOf(chain, first, last, span, f, sharper);
    blur = sharper;
  }
  if (gap.length <= kClosed * gap.springs) return f;
  throw InputError(
      "found no rest position of the chain in which all springs are stretched: move its held "
      "particles apart");
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
      result.positions().row(i) =
          result.positions().row(i - 1) + separationAt(spring, force).transpose();
      force -= loadOn(chain, i);
    }
  };
  Eigen::Index first = 0;
  for (Eigen::Index last = 1; last < chain.size(); ++last) {
    if (!chain.isHeld(last)) continue;
    const Vector span = (state.positions().row(last) - state.positions().row(first)).transpose();
    if (last > first + 1) hang(first, last, firstForce(chain, first, last, span));
    first = last;
  }
  Vector weight = Vector::Zero();
  for (Eigen::Index i = first + 1; i < chain.size(); ++i) weight += loadOn(chain, i);
  hang(first, chain.size(), weight);
  const Eigen::Index springs = chain.size() - 1;
  const auto x = result.x().array(), y = result.y().array();
  if ((x.head(springs) == x.tail(springs) && y.head(springs) == y.tail(springs)).any()) {
    throw InputError(
        "a chain at rest with a spring of length 0 cannot move on: give it a rest length, gravity, "
        "or held particles that are apart");
  }
  if (!result.values().allFinite()) {
    throw InputError(
        "the chain at rest is longer than a double can hold: the stiffness must be larger");
  }
  return result;
}

}  // namespace spring_pendulum
