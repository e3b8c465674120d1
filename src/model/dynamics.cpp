#include "base/checks.hpp"
#include <spring_pendulum/model/dynamics.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace spring_pendulum {
namespace {

PlaneVector<double> forceOn(const SpringLaw& law, const State& state, std::ptrdiff_t i) {
  const Eigen::RowVector4d spring = state.values().row(i + 1) - state.values().row(i);
  return springForce<double>(law, {spring[0], spring[1]}, {spring[2], spring[3]});
}

}  // namespace

PlaneVector<double> springForceOn(const Chain& chain, const State& state, std::ptrdiff_t i) {
  requireSize(chain.size(), state.size());
  if (i < 0 || i + 1 >= chain.size()) {
    throw InputError(
        fmt::format("spring {} does not exist: a chain of {} particles has springs 0 to {}", i,
                    chain.size(), chain.size() - 2));
  }
  return forceOn(chain.spring(), state, i);
}

double chainLength(const Chain& chain, const State& start) {
  requireSize(chain.size(), start.size());
  const Eigen::Index springs = start.size() - 1;
  return std::max(static_cast<double>(springs) * chain.spring().rest_length,
                  0.1 * springLengths(start, 0, springs));
}

void computeSlope(const Chain& chain, const State& state, State& slope) {
  requireSize(chain.size(), state.size());
  if (&slope == &state) throw InputError("computeSlope: slope and state must be different objects");
  const std::ptrdiff_t size = chain.size();
  if (slope.size() != size) slope = State(size);
  slope.positions() = state.velocities();
  slope.values().row(0).setZero();
  if (chain.isDriven()) {
    const PlaneVector<double> anchor = chain.springlessAcceleration(0);
    slope.values().row(0) << state.vx()[0], state.vy()[0], anchor.x, anchor.y;
  }
  PlaneVector<double> left = size > 1 ? forceOn(chain.spring(), state, 0) : PlaneVector<double>{};
  for (std::ptrdiff_t i = 1; i < size; ++i) {
    const bool free_end = i + 1 == size;
    const auto right = free_end ? PlaneVector<double>{} : forceOn(chain.spring(), state, i);
    const double inverse_mass = chain.inverseMasses()[i];
    const PlaneVector<double> springless = chain.springlessAcceleration(i);
    slope.vx()[i] = (right.x - left.x) * inverse_mass;
    if (chain.isDriven()) slope.vx()[i] += springless.x;
    slope.vy()[i] = fused(right.y - left.y, inverse_mass, springless.y);
    if (chain.airDrag() != 0.0) {
      const double rate = chain.airDrag() * inverse_mass;
      slope.vx()[i] = fused(-rate, state.vx()[i], slope.vx()[i]);
      slope.vy()[i] = fused(-rate, state.vy()[i], slope.vy()[i]);
    }
    left = right;
  }
}

}  // namespace spring_pendulum
