// Kernels that do one stage of any tableau over a whole chain.
#pragma once

#include <spring_pendulum/integration/chain_kernels.hpp>

#include <cstddef>

#include "block.hpp"

namespace spring_pendulum {
namespace {

inline Block combinedBlock(std::ptrdiff_t pitch, const double* state, SlopeSum sum,
                           std::ptrdiff_t block) {
  Block result = loadBlock(state, pitch, block);
  for (std::ptrdiff_t k = 0; k < sum.count; ++k) {
    const Block slope = loadBlock(sum.terms[k].slope, pitch, block);
    result = plusWeighted(result, sum.terms[k].weight, slope);
  }
  return result;
}

template <bool kDamped>
void stageSlope(const KernelChain& chain, const double* state, SlopeSum sum, double* slope) {
  const std::ptrdiff_t blocks = blocksOf(chain.size);
  Block here = combinedBlock(chain.pitch, state, sum, 0);
  PlaneVector<Pack> left{};
  for (std::ptrdiff_t block = 0; block < blocks; ++block) {
    const Block next =
        block + 1 < blocks ? combinedBlock(chain.pitch, state, sum, block + 1) : here;
    const PlaneVector<Pack> right = forcesFromRight<kDamped>(chain, here, next, block);
    storeBlock(slopeOf<true>(chain, here, left, right, block), slope, chain.pitch, block);
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
    storeBlock(combinedBlock(pitch, state, sum, block), out, pitch, block);
  }
}

/// A maximum that also remembers whether anything was not finite, which a comparison forgets.
class Largest {
 public:
  void add(Pack value) {
    largest_ = larger(largest_, absolute(value));
    not_finite_ = not_finite_ + (value - value);
  }
  double result() const {
    double result = 0.0;
    double not_finite = 0.0;
    for (int lane = 0; lane < kLanes; ++lane) {
      result = largest_.lanes[lane] > result ? largest_.lanes[lane] : result;
      not_finite += not_finite_.lanes[lane];
    }
    return result + not_finite;
  }

 private:
  Pack largest_;
  Pack not_finite_;
};

LargestChange largestChange(std::ptrdiff_t size, std::ptrdiff_t pitch, SlopeSum sum) {
  Largest position;
  Largest velocity;
  for (std::ptrdiff_t block = 0; block < blocksOf(size); ++block) {
    Block change{};
    for (std::ptrdiff_t k = 0; k < sum.count; ++k) {
      const Block slope = loadBlock(sum.terms[k].slope, pitch, block);
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
