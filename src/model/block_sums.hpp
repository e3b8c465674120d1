// Sums over the springs of a chain have a fixed order: over blocks of springs from left to right, and
// then over the blocks.
#pragma once

#include <algorithm>
#include <cstddef>

namespace spring_pendulum {

/// Returns the number of springs per block, a multiple of 8.
inline std::ptrdiff_t sumBlockSize(std::ptrdiff_t springs) {
  constexpr std::ptrdiff_t kLeast = 64;
  constexpr std::ptrdiff_t kMostBlocks = 1 << 16;
  return std::max(kLeast, (springs / kMostBlocks + 8) / 8 * 8);
}

}  // namespace spring_pendulum
