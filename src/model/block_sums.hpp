// Sums over the springs of a chain have a fixed order: over blocks of springs from left to right, and
// then over the blocks. Machines that share a chain at the borders of blocks get the bits of one.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/energy.hpp>
#include <spring_pendulum/model/state.hpp>

#include <algorithm>
#include <cstddef>

namespace spring_pendulum {

/// Returns the number of springs per block, a multiple of 8. Even the longest chain has few enough
/// blocks to send all their sums to one machine in every frame.
inline std::ptrdiff_t sumBlockSize(std::ptrdiff_t springs) {
  constexpr std::ptrdiff_t kLeast = 64;
  constexpr std::ptrdiff_t kMostBlocks = 1 << 16;
  return std::max(kLeast, (springs / kMostBlocks + 8) / 8 * 8);
}

/// Returns the energies of the springs first <= i < last, where spring i is to the right of particle i,
/// and of the particles at their right ends.
/// \param height y coordinate without potential energy, m
Energy energyOfSprings(const Chain& chain, const State& state, std::ptrdiff_t first,
                       std::ptrdiff_t last, double height);

inline Energy& operator+=(Energy& sum, const Energy& energy) {
  sum.kinetic += energy.kinetic;
  sum.gravity += energy.gravity;
  sum.spring += energy.spring;
  return sum;
}

}  // namespace spring_pendulum
