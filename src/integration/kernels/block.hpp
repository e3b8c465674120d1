// A block of `kLanes` neighbouring particles, the unit of work of every kernel.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/instruction_sets/pack.hpp"
#include <spring_pendulum/model/spring_law.hpp>

#include <cstddef>

namespace spring_pendulum {
namespace {

/// State or slope of the particles of a block.
struct Block {
  Pack x, y, vx, vy;
};

/// Address of a block in memory: x at `first`, then y, vx and vy, each `pitch` doubles further.
template <typename Number>
struct BlockPlace {
  Number* first;
  std::ptrdiff_t pitch;
};

[[gnu::always_inline]] inline Block load(BlockPlace<const double> from) {
  return {Pack::load(from.first), Pack::load(from.first + from.pitch),
          Pack::load(from.first + 2 * from.pitch), Pack::load(from.first + 3 * from.pitch)};
}

[[gnu::always_inline]] inline void store(const Block& value, BlockPlace<double> to) {
  value.x.store(to.first);
  value.y.store(to.first + to.pitch);
  value.vx.store(to.first + 2 * to.pitch);
  value.vy.store(to.first + 3 * to.pitch);
}

[[gnu::always_inline]] inline Block operator+(const Block& a, const Block& b) {
  return {a.x + b.x, a.y + b.y, a.vx + b.vx, a.vy + b.vy};
}
[[gnu::always_inline]] inline Block operator-(const Block& a, const Block& b) {
  return {a.x - b.x, a.y - b.y, a.vx - b.vx, a.vy - b.vy};
}

/// Returns state + weight * slope.
[[gnu::always_inline]] inline Block plusWeighted(const Block& state, double weight,
                                                 const Block& slope) {
  return {fused(weight, slope.x, state.x), fused(weight, slope.y, state.y),
          fused(weight, slope.vx, state.vx), fused(weight, slope.vy, state.vy)};
}

/// Number of blocks of a chain of `size` particles.
[[gnu::always_inline]] inline std::ptrdiff_t blocksOf(std::ptrdiff_t size) {
  return (size + kLanes - 1) / kLanes;
}

/// Returns the force on each particle of a block from the spring to its right neighbour, 0 for the
/// last particle of the chain. Without damping no velocity is read, which changes no bit.
template <bool kDamped>
[[gnu::always_inline]] inline PlaneVector<Pack> forcesFromRight(const KernelChain& chain,
                                                                const Block& here,
                                                                const Block& right,
                                                                std::ptrdiff_t block) {
  const PlaneVector<Pack> separation{rightNeighbours(here.x, right.x) - here.x,
                                     rightNeighbours(here.y, right.y) - here.y};
  PlaneVector<Pack> force;
  if constexpr (kDamped) {
    const PlaneVector<Pack> approach{rightNeighbours(here.vx, right.vx) - here.vx,
                                     rightNeighbours(here.vy, right.vy) - here.vy};
    force = springForce(chain.spring, separation, approach);
  } else {
    force = undampedSpringForce(chain.spring, separation);
  }
  const std::ptrdiff_t springs = chain.size - 1 - block * kLanes;
  if (springs < kLanes) force = {only(force.x, 0, springs), only(force.y, 0, springs)};
  return force;
}

/// dissipated += weight * rate², with weight = k_d times a time, kg.
[[gnu::always_inline]] inline void addDissipation(double weight, Pack rate, double* dissipated) {
  fused(weight, rate * rate, Pack::load(dissipated)).store(dissipated);
}

/// Returns the slope of a block.
/// \param left, right forces of the springs to the right of each particle, in the block to the left
///   and in this block
/// \tparam kInner whether the block is neither the first nor the last, so that all its particles
///   move
template <bool kGravity, bool kInner = false>
[[gnu::always_inline]] inline Block slopeOf(const KernelChain& chain, const Block& here,
                                            const PlaneVector<Pack>& left,
                                            const PlaneVector<Pack>& right, std::ptrdiff_t block) {
  const Pack inverse_mass = Pack::load(chain.inverse_masses + chain.mass_stride * (block * kLanes));
  const PlaneVector<Pack> force{right.x - leftNeighbours(left.x, right.x),
                                right.y - leftNeighbours(left.y, right.y)};
  Block slope{here.vx, here.vy, force.x * inverse_mass, {}};
  if constexpr (kGravity) {
    slope.vy = fused(force.y, inverse_mass, -chain.gravity);
  } else {
    slope.vy = force.y * inverse_mass;
  }
  const std::ptrdiff_t particles = chain.size - block * kLanes;
  if (!kInner && (block == 0 || particles < kLanes)) {
    const std::ptrdiff_t first_moving = block == 0 ? 1 : 0;
    slope = {only(slope.x, first_moving, particles), only(slope.y, first_moving, particles),
             only(slope.vx, first_moving, particles), only(slope.vy, first_moving, particles)};
  }
  return slope;
}

}  // namespace
}  // namespace spring_pendulum
