// Kernels that do one stage of any tableau over a whole chain.
#pragma once

#include <spring_pendulum/integration/chain_kernels.hpp>

#include <cstddef>

#include "block.hpp"
#include "largest.hpp"

namespace spring_pendulum {
namespace {

[[gnu::always_inline]] inline Block combinedBlock(std::ptrdiff_t pitch, const double* state,
                                                  SlopeSum sum, std::ptrdiff_t block) {
  Block result = load({state + block * kLanes, pitch});
  for (std::ptrdiff_t k = 0; k < sum.count; ++k) {
    const Block slope = load({sum.terms[k].slope + block * kLanes, pitch});
    result = plusWeighted(result, sum.terms[k].weight, slope);
  }
  return result;
}

// The chain's constants are copied: of the caller's the compiler must assume that they change with
// every number that is written.
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

template <bool kDamped>
void recurrence(const KernelChain& chain, const double* last, const double* before, double kappa,
                double weight, double* out) {
  const std::ptrdiff_t blocks = blocksOf(chain.size);
  const std::ptrdiff_t pitch = chain.pitch;
  Block here = load({last, pitch});
  PlaneVector<Pack> left{};
  for (std::ptrdiff_t block = 0; block < blocks; ++block) {
    const std::ptrdiff_t next_block = block + 1 < blocks ? block + 1 : block;
    const Block next = load({last + next_block * kLanes, pitch});
    const PlaneVector<Pack> right = forcesFromRight<kDamped>(chain, here, next, block);
    const Block slope = slopeOf<true>(chain, here, left, right, block);
    const Block old = load({before + block * kLanes, pitch});
    const Block back{old.x - here.x, old.y - here.y, old.vx - here.vx, old.vy - here.vy};
    store(plusWeighted(plusWeighted(here, kappa, back), weight, slope),
          {out + block * kLanes, pitch});
    left = right;
    here = next;
  }
}

void recurrence(const KernelChain& chain, const double* last, const double* before, double kappa,
                double weight, double* out) {
  if (chain.spring.damping == 0.0) {
    return recurrence<false>(chain, last, before, kappa, weight, out);
  }
  recurrence<true>(chain, last, before, kappa, weight, out);
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

}  // namespace
}  // namespace spring_pendulum
