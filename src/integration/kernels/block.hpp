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

template <typename Number>
[[gnu::always_inline]] inline Block load(BlockPlace<Number> from) {
  return {Pack::load(from.first), Pack::load(from.first + from.pitch),
          Pack::load(from.first + 2 * from.pitch), Pack::load(from.first + 3 * from.pitch)};
}

[[gnu::always_inline]] inline void store(const Block& value, BlockPlace<double> to) {
  value.x.store(to.first);
  value.y.store(to.first + to.pitch);
  value.vx.store(to.first + 2 * to.pitch);
  value.vy.store(to.first + 3 * to.pitch);
}

[[gnu::always_inline]] inline PlaneVector<Pack> load(const double* from) {
  return {Pack::load(from), Pack::load(from + kLanes)};
}

[[gnu::always_inline]] inline void store(const PlaneVector<Pack>& value, double* to) {
  value.x.store(to);
  value.y.store(to + kLanes);
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

/// Number of blocks of a chain of `size` particles, at least 1.
[[gnu::always_inline]] inline std::ptrdiff_t blocksOf(std::ptrdiff_t size) {
  return size > 1 ? (size - 2) / kLanes + 1 : 1;
}

/// Returns where a block of moving particles lies; block -1 ends with the fixed particle.
template <typename Number>
[[gnu::always_inline]] inline BlockPlace<Number> placeOf(Number* state, std::ptrdiff_t pitch,
                                                         std::ptrdiff_t block) {
  return {state + kFirstMoving + block * kLanes, pitch};
}

/// Returns the states of the left neighbours of a block's particles, where `left` precedes `here`.
[[gnu::always_inline]] inline Block leftNeighbours(const Block& left, const Block& here) {
  return {leftNeighbours(left.x, here.x), leftNeighbours(left.y, here.y),
          leftNeighbours(left.vx, here.vx), leftNeighbours(left.vy, here.vy)};
}

/// Square of the length, m², that the rounding errors of the coordinates of the ends of springs can reach.
[[gnu::always_inline]] inline Pack squareOfRounding(const Block& ends) {
  return (ends.x * ends.x + ends.y * ends.y) * 0x1p-98;
}

/// Returns the separations of the particles of a block from their left neighbours.
[[gnu::always_inline]] inline PlaneVector<Pack> separationsOf(const Block& left,
                                                              const Block& here) {
  return {here.x - leftNeighbours(left.x, here.x), here.y - leftNeighbours(left.y, here.y)};
}

/// Returns the velocities of the particles of a block relative to their left neighbours.
[[gnu::always_inline]] inline PlaneVector<Pack> relativeVelocitiesOf(const Block& left,
                                                                     const Block& here) {
  return {here.vx - leftNeighbours(left.vx, here.vx), here.vy - leftNeighbours(left.vy, here.vy)};
}

/// Returns the forces of the springs of a block with those behind the end of the chain set to 0.
[[gnu::always_inline]] inline PlaneVector<Pack> onlySprings(const PlaneVector<Pack>& force,
                                                            const KernelChain& chain,
                                                            std::ptrdiff_t block) {
  const std::ptrdiff_t springs = chain.size - 1 - block * kLanes;
  if (springs >= kLanes) return force;
  return {only(force.x, springs), only(force.y, springs)};
}

/// dissipated += weight * rate², with weight = k_d times a time, kg.
[[gnu::always_inline]] inline void addDissipation(double weight, Pack rate, double* dissipated) {
  fused(weight, rate * rate, Pack::load(dissipated)).store(dissipated);
}

/// Returns the slope of a block.
/// \param forces, next_forces forces of the springs to the left of each particle, in this block and
///   in the block to the right
/// \tparam kInner whether the block is not the last, so that it contains no padding
template <bool kInner = false>
[[gnu::always_inline]] inline Block slopeOf(const KernelChain& chain, const Block& here,
                                            const PlaneVector<Pack>& forces,
                                            const PlaneVector<Pack>& next_forces,
                                            std::ptrdiff_t block) {
  const Pack inverse_mass = Pack::load(chain.inverse_masses + block * kLanes);
  const PlaneVector<Pack> force{rightNeighbours(forces.x, next_forces.x) - forces.x,
                                rightNeighbours(forces.y, next_forces.y) - forces.y};
  Block slope{here.vx, here.vy, force.x * inverse_mass,
              fused(force.y, inverse_mass, -chain.gravity)};
  const std::ptrdiff_t particles = chain.size - 1 - block * kLanes;
  if (!kInner && particles < kLanes)
    slope = {only(slope.x, particles), only(slope.y, particles), only(slope.vx, particles),
             only(slope.vy, particles)};
  return slope;
}

}  // namespace
}  // namespace spring_pendulum
