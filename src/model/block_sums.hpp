// Sums over springs go from left to right within blocks, then over the blocks: the same bits on every machine.
#pragma once

#include <algorithm>
#include <cstddef>

namespace spring_pendulum {

/// Returns the number of springs per block, a multiple of 8.
inline std::ptrdiff_t sumBlockSize(std::ptrdiff_t springs) {
  return std::max<std::ptrdiff_t>(64, (springs / (1 << 16) + 8) / 8 * 8);
}

}  // namespace spring_pendulum
