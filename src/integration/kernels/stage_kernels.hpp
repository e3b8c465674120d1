// Kernels that work through a whole chain: one stage of any tableau, sums, also of Taylor series, and
// error norms.
#pragma once

#include "integration/kernels/block.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/instruction_sets/pack.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace spring_pendulum {
namespace {

/// Change of a spring, relative to its length, that counts as much.
constexpr double kMuch = 0.9;

/// Length of a spring, m, that counts as much if its length was 0. A spring of length 0 exerts no
/// force; up to this length that makes no difference.
constexpr double kNoLength = 1e-12;

/// A maximum of absolute values that becomes NaN if a value is not finite. It compares the bits of
/// the numbers as integers: those of infinity and NaN are larger than those of finite numbers. A
/// comparison of the numbers would ignore NaN.
class Largest {
 public:
  [[gnu::always_inline]] void add(Pack value) {
    const Pack::Bits bits = absoluteBits(value);
    largest_ = bits > largest_ ? bits : largest_;
  }
  [[gnu::always_inline]] double result() const {
    std::int64_t largest = 0;
    for (int lane = 0; lane < kLanes; ++lane)
      if (largest_[lane] > largest) largest = largest_[lane];
    double result = 0.0;
    std::memcpy(&result, &largest, sizeof(result));
    return result + (result - result);
  }

 private:
  Pack::Bits largest_{};
};

[[gnu::always_inline]] inline Block plusSum(Block result, const SlopeSum& sum, std::ptrdiff_t pitch,
                                            std::ptrdiff_t block) {
  for (std::ptrdiff_t k = 0; k < sum.count; ++k) {
    const Block slope = load(placeOf(sum.terms[k].slope, pitch, block));
    result = plusWeighted(result, sum.terms[k].weight, slope);
  }
  return result;
}

[[gnu::always_inline]] inline Block combinedBlock(std::ptrdiff_t pitch, const double* state,
                                                  const SlopeSum& sum, std::ptrdiff_t block) {
  return plusSum(load(placeOf(state, pitch, block)), sum, pitch, block);
}

void addWeighted(std::ptrdiff_t count, double weight, const double* from, double* to) {
  for (std::ptrdiff_t first = 0; first < count; first += kLanes) {
    fused(weight, Pack::load(from + first), Pack::load(to + first)).store(to + first);
  }
}

/// Subtracts the deceleration by the air, k_air/m times the velocity, from both columns.
inline void addDrag(const KernelChain& chain, const double* velocities, double* accelerations) {
  for (int column = 0; column < 2; ++column) {
    for (std::ptrdiff_t first = 0; first < blocksOf(chain.size) * kLanes; first += kLanes) {
      const std::ptrdiff_t at = column * chain.pitch + first;
      fused(-Pack::load(chain.drag_rates + first), Pack::load(velocities + at),
            Pack::load(accelerations + at))
          .store(accelerations + at);
    }
  }
}

// Local copy of the chain: through the reference it would be reloaded after every store.
template <bool kDamped>
void stageSlope(const KernelChain& callers_chain, const double* state, const SlopeSum& sum,
                double* slope) {
  const KernelChain chain = callers_chain;
  const std::ptrdiff_t blocks = blocksOf(chain.size);
  Block here = combinedBlock(chain.pitch, state, sum, blocks - 1);
  PlaneVector<Pack> next_forces{};
  for (std::ptrdiff_t block = blocks - 1; block >= 0; --block) {
    const Block left = combinedBlock(chain.pitch, state, sum, block - 1);
    const PlaneVector<Pack> separation = separationsOf(left, here);
    PlaneVector<Pack> forces;
    if constexpr (kDamped) {
      forces = springForce(chain.spring, separation, relativeVelocitiesOf(left, here));
    } else {  // no velocity is read, which changes no bit
      forces = undampedSpringForce(chain.spring, separation, inverseLength(separation));
    }
    forces = onlySprings(forces, chain, block);
    store(slopeOf(chain, here, forces, next_forces, block), placeOf(slope, chain.pitch, block));
    next_forces = forces;
    here = left;
  }
  store({}, placeOf(slope, chain.pitch, -1));
}

void stageSlope(const KernelChain& chain, const double* state, const SlopeSum& sum, double* slope) {
  const auto spring_slope = chain.spring.damping == 0.0 ? stageSlope<false> : stageSlope<true>;
  spring_slope(chain, state, sum, slope);
  double* accelerations = slope + 2 * chain.pitch + kFirstMoving;
  if (chain.drive != nullptr) {
    const Block before = combinedBlock(chain.pitch, state, sum, -1);
    store({before.vx, before.vy, {}, {}}, placeOf(slope, chain.pitch, -1));
    for (int column = 0; column < 2; ++column) {
      accelerations[column * chain.pitch - 1] = chain.anchor[column];
      addWeighted(blocksOf(chain.size) * kLanes, 1.0, chain.drive + column * chain.pitch,
                  accelerations + column * chain.pitch);
    }
  }
  if (chain.drag_rates != nullptr) addDrag(chain, slope + kFirstMoving, accelerations);
}

void combine(std::ptrdiff_t pitch, const double* state, const SlopeSum& sum, double* out) {
  for (std::ptrdiff_t block = -1; block < (pitch - kFirstMoving) / kLanes; ++block) {
    store(combinedBlock(pitch, state, sum, block), placeOf(out, pitch, block));
  }
}

void addDissipation(const KernelChain& callers_chain, const double* state, double weight,
                    double* dissipated) {
  const KernelChain chain = callers_chain;
  const std::ptrdiff_t blocks = blocksOf(chain.size);
  for (std::ptrdiff_t block = 0; block < blocks; ++block) {
    const Block left = load(placeOf(state, chain.pitch, block - 1));
    const Block here = load(placeOf(state, chain.pitch, block));
    const Pack rate = elongationRate(separationsOf(left, here), relativeVelocitiesOf(left, here));
    addDissipation(weight, rate, dissipated + block * kLanes);
  }
}

void compensatedSum(std::ptrdiff_t pitch, const double* state, const double* change,
                    const SlopeSum& sum, double* out, double* lost) {
  for (std::ptrdiff_t block = -1; block < (pitch - kFirstMoving) / kLanes; ++block) {
    const Block from = load(placeOf(state, pitch, block));
    const Block step = combinedBlock(pitch, change, sum, block);
    const Block to = from + step;
    store(to, placeOf(out, pitch, block));
    store(step - (to - from), placeOf(lost, pitch, block));
  }
}

/// Returns the largest absolute values in the blocks of `size` particles.
template <typename OfBlock>
[[gnu::always_inline]] inline LargestChange largestOf(std::ptrdiff_t size,
                                                      const OfBlock& of_block) {
  Largest position;
  Largest velocity;
  for (std::ptrdiff_t block = 0; block < blocksOf(size); ++block) {
    const Block change = of_block(block);
    position.add(change.x);
    position.add(change.y);
    velocity.add(change.vx);
    velocity.add(change.vy);
  }
  return {position.result(), velocity.result()};
}

LargestChange largestChange(std::ptrdiff_t size, std::ptrdiff_t pitch, const SlopeSum& sum) {
  return largestOf(size, [&](std::ptrdiff_t block) { return plusSum({}, sum, pitch, block); });
}

SpringChange springChange(std::ptrdiff_t size, std::ptrdiff_t pitch, double h, const double* from,
                          const double* to) {
  // Lanes are all ones where the condition holds, also for NaN; else 0.
  const auto reaches = [](Pack value, Pack limit) { return ~(value.lanes < limit.lanes); };
  Pack::Bits much{};
  Pack::Bits unclear{};
  for (std::ptrdiff_t block = 0; block < blocksOf(size); ++block) {
    const auto springs_of = [pitch, block](const double* state) {
      const Block here = load(placeOf(state, pitch, block));
      return here - leftNeighbours(load(placeOf(state, pitch, block - 1)), here);
    };
    const Block before = springs_of(from);
    const Block after = springs_of(to);
    const auto along = [&](const PlaneVector<Pack>& a) {
      return fused(before.x, a.x, before.y * a.y);
    };
    const PlaneVector<Pack> change{after.x - before.x, after.y - before.y};
    const Pack at_end = along(change);
    const Pack slowing = along({before.vx - after.vx, before.vy - after.vy});
    // The cubic through positions and velocities of both ends estimates the change until the middle.
    const Pack in_middle = fused(0.125 * h, slowing, 0.5 * at_end);
    const Pack square = before.x * before.x + before.y * before.y;
    const Pack grown = change.x * change.x + change.y * change.y;
    const Pack::Bits without = reaches(grown, kNoLength * kNoLength);
    const Pack noise = squareOfRounding(load(placeOf(from, pitch, block)));
    const Pack::Bits with = reaches(absolute(at_end), kMuch * square);
    const Pack::Bits springs = laneNumbers().lanes < static_cast<double>(size - 1 - block * kLanes);
    much |= springs & reaches(grown, noise) & (square.lanes == 0.0 ? without : with);
    // Half the limit, because the estimate is coarse.
    unclear |= springs & reaches(absolute(in_middle), 0.5 * kMuch * square);
  }
  const auto any = [](Pack::Bits marked) {
    std::int64_t all = 0;
    for (int lane = 0; lane < kLanes; ++lane) all |= marked[lane];
    return all != 0;
  };
  if (any(much)) return SpringChange::kMuch;
  return any(unclear) ? SpringChange::kUnclear : SpringChange::kLittle;
}

/// Returns the weighted sum of the acceleration coefficients of one block.
[[gnu::always_inline]] inline Block weightedSum(const TaylorWorkspace& work,
                                                const TaylorWeights& weights,
                                                std::ptrdiff_t block) {
  Block change{};
#pragma GCC unroll 1
  for (std::ptrdiff_t n = weights.count - 1; n >= 0; --n) {
    const double* row = work.accelerations + n * 2 * work.chain.pitch + block * kLanes;
    const Pack x = Pack::load(row);
    const Pack y = Pack::load(row + work.chain.pitch);
    const double position = weights.position[n];
    const double velocity = weights.velocity[n];
    change = {fused(position, x, change.x), fused(position, y, change.y),
              fused(velocity, x, change.vx), fused(velocity, y, change.vy)};
  }
  return change;
}

void taylorState(const TaylorWorkspace& callers_work, const double* state, const double* base,
                 const TaylorWeights& weights, double* out) {
  const TaylorWorkspace work = callers_work;
  const double time = weights.start_velocity;
  const double* velocity =
      state + 2 * work.chain.pitch + kFirstMoving - 1;  // of the first particle
  const double start_velocity[] = {velocity[0], velocity[work.chain.pitch]};
  store(load(placeOf(base, work.chain.pitch, -1)), placeOf(out, work.chain.pitch, -1));
  for (int column = 0; work.chain.drive != nullptr && column < 2; ++column) {
    const double acceleration = work.chain.anchor[column];
    double* place = out + column * work.chain.pitch + kFirstMoving - 1;
    place[0] += time * start_velocity[column] + weights.position[0] * acceleration;
    place[2 * work.chain.pitch] += weights.velocity[0] * acceleration;
  }
  for (std::ptrdiff_t block = 0; block < blocksOf(work.chain.size); ++block) {
    const Block change = weightedSum(work, weights, block);
    const Block start = load(placeOf(state, work.chain.pitch, block));
    const Block from = load(placeOf(base, work.chain.pitch, block));
    store({from.x + fused(time, start.vx, change.x), from.y + fused(time, start.vy, change.y),
           from.vx + change.vx, from.vy + change.vy},
          placeOf(out, work.chain.pitch, block));
  }
}

LargestChange taylorLargestSum(const TaylorWorkspace& work, const TaylorWeights& weights) {
  return largestOf(work.chain.size,
                   [&](std::ptrdiff_t block) { return weightedSum(work, weights, block); });
}

LastCoefficients lastCoefficients(const TaylorWorkspace& work) {
  const std::ptrdiff_t end = blocksOf(work.chain.size) * kLanes;
  const auto size_of = [&](std::ptrdiff_t n) {
    const double* x = work.accelerations + n * 2 * work.chain.pitch;
    const double* y = x + work.chain.pitch;
    Largest largest;
    for (std::ptrdiff_t first = 0; first < end; first += kLanes) {
      largest.add(Pack::load(x + first));
      largest.add(Pack::load(y + first));
    }
    return largest.result();
  };
  const std::ptrdiff_t last = work.order - 1;
  return {{size_of(last), size_of(last - 1), size_of(last - 2), size_of(last - 3)}};
}

}  // namespace
}  // namespace spring_pendulum
