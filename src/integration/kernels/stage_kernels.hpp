// Kernels that work through a whole chain: one stage of any tableau, sums, and error norms.
#pragma once

#include "integration/kernels/block.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/largest.hpp"

#include <cstddef>

namespace spring_pendulum {
namespace {

/// Change of a spring, relative to its length, that counts as much.
constexpr double kMuch = 0.9;

/// Length of a spring, m, that counts as much if its length was 0. A spring of length 0 exerts no
/// force; up to this length that makes no difference.
constexpr double kNoLength = 1e-12;

[[gnu::always_inline]] inline Block combinedBlock(std::ptrdiff_t pitch, const double* state,
                                                  SlopeSum sum, std::ptrdiff_t block) {
  Block result = load({state + block * kLanes, pitch});
  for (std::ptrdiff_t k = 0; k < sum.count; ++k) {
    const Block slope = load({sum.terms[k].slope + block * kLanes, pitch});
    result = plusWeighted(result, sum.terms[k].weight, slope);
  }
  return result;
}

// Local copy of the chain: through the reference it would be reloaded after every store.
template <bool kDamped>
void stageSlope(const KernelChain& callers_chain, const double* state, SlopeSum sum,
                double* slope) {
  const KernelChain chain = callers_chain;
  const std::ptrdiff_t blocks = blocksOf(chain.size);
  Block here = combinedBlock(chain.pitch, state, sum, 0);
  PlaneVector<Pack> left{};
  for (std::ptrdiff_t block = 0; block < blocks; ++block) {
    const std::ptrdiff_t next_block = block + 1 < blocks ? block + 1 : block;
    const Block next = combinedBlock(chain.pitch, state, sum, next_block);
    const PlaneVector<Pack> right = forcesFromRight<kDamped>(chain, here, next, block);
    store(slopeOf<true>(chain, here, left, right, block), {slope + block * kLanes, chain.pitch});
    left = right;
    here = next;
  }
}

void stageSlope(const KernelChain& chain, const double* state, SlopeSum sum, double* slope) {
  if (chain.spring.damping == 0.0) return stageSlope<false>(chain, state, sum, slope);
  stageSlope<true>(chain, state, sum, slope);
}

void combine(std::ptrdiff_t pitch, const double* state, SlopeSum sum, double* out) {
  for (std::ptrdiff_t block = 0; block < pitch / kLanes; ++block) {
    store(combinedBlock(pitch, state, sum, block), {out + block * kLanes, pitch});
  }
}

void addDissipation(const KernelChain& callers_chain, const double* state, double weight,
                    double* dissipated) {
  const KernelChain chain = callers_chain;
  const std::ptrdiff_t blocks = blocksOf(chain.size);
  for (std::ptrdiff_t block = 0; block < blocks; ++block) {
    const Block here = load({state + block * kLanes, chain.pitch});
    const Block next =
        block + 1 < blocks ? load({state + (block + 1) * kLanes, chain.pitch}) : here;
    const PlaneVector<Pack> separation{rightNeighbours(here.x, next.x) - here.x,
                                       rightNeighbours(here.y, next.y) - here.y};
    const PlaneVector<Pack> approach{rightNeighbours(here.vx, next.vx) - here.vx,
                                     rightNeighbours(here.vy, next.vy) - here.vy};
    addDissipation(weight, elongationRate(separation, approach), dissipated + block * kLanes);
  }
}

void addWeighted(std::ptrdiff_t count, double weight, const double* from, double* to) {
  for (std::ptrdiff_t first = 0; first < count; first += kLanes) {
    fused(weight, Pack::load(from + first), Pack::load(to + first)).store(to + first);
  }
}

void compensatedSum(std::ptrdiff_t pitch, const double* state, const double* change, SlopeSum sum,
                    double* out, double* lost) {
  for (std::ptrdiff_t block = 0; block < pitch / kLanes; ++block) {
    const std::ptrdiff_t first = block * kLanes;
    const Block from = load({state + first, pitch});
    const Block step = combinedBlock(pitch, change, sum, block);
    const Block to = from + step;
    store(to, {out + first, pitch});
    store(step - (to - from), {lost + first, pitch});
  }
}

LargestChange largestChange(std::ptrdiff_t size, std::ptrdiff_t pitch, SlopeSum sum) {
  Largest position;
  Largest velocity;
  for (std::ptrdiff_t block = 0; block < blocksOf(size); ++block) {
    Block change{};
    for (std::ptrdiff_t k = 0; k < sum.count; ++k) {
      const Block slope = load({sum.terms[k].slope + block * kLanes, pitch});
      change = plusWeighted(change, sum.terms[k].weight, slope);
    }
    position.add(change.x);
    position.add(change.y);
    velocity.add(change.vx);
    velocity.add(change.vy);
  }
  return {position.result(), velocity.result()};
}

/// Returns the separations of the particles of a block from their right neighbours.
[[gnu::always_inline]] inline PlaneVector<Pack> separations(const double* state,
                                                            std::ptrdiff_t pitch,
                                                            std::ptrdiff_t block,
                                                            std::ptrdiff_t next) {
  const auto difference = [block, next](const double* column) {
    const Pack here = Pack::load(column + block * kLanes);
    return rightNeighbours(here, Pack::load(column + next * kLanes)) - here;
  };
  return {difference(state), difference(state + pitch)};
}

bool springsChangeMuch(std::ptrdiff_t size, std::ptrdiff_t pitch, const double* from,
                       const double* to) {
  Pack much;
  const std::ptrdiff_t blocks = blocksOf(size);
  for (std::ptrdiff_t block = 0; block < blocks; ++block) {
    const std::ptrdiff_t next = block + 1 < blocks ? block + 1 : block;
    const PlaneVector<Pack> before = separations(from, pitch, block, next);
    const PlaneVector<Pack> after = separations(to, pitch, block, next);
    const PlaneVector<Pack> change{after.x - before.x, after.y - before.y};
    const Pack along = absolute(before.x * change.x + before.y * change.y);
    const Pack square = before.x * before.x + before.y * before.y;
    const Pack grown = change.x * change.x + change.y * change.y;
    const Pack::Native one = Pack::all(1.0).lanes;
    const Pack::Native with_length = along.lanes < (kMuch * square).lanes ? Pack::Native{} : one;
    const Pack::Native without = grown.lanes < kNoLength * kNoLength ? Pack::Native{} : one;
    const Pack counted = {square.lanes == 0.0 ? without : with_length};
    much = much + only(counted, 0, size - 1 - block * kLanes);
  }
  double sum = 0.0;
  for (int lane = 0; lane < kLanes; ++lane) sum += much.lanes[lane];
  return sum > 0.0;
}

}  // namespace
}  // namespace spring_pendulum
