// Whole steps of an explicit Runge-Kutta method in one pass over the chain, in place.
//
// Stage i of a block needs no more than stage i-1 of that block and the next. So the stages follow
// each other along the chain like machines along a conveyor, two blocks apart, and all that passes
// between them fits the innermost cache:
//
//     tick t:   stage 4 of block t-6,  stage 3 of block t-4,  stage 2 of block t-2,  stage 1 of t
//
// The stages of one tick need nothing of each other; the processor does them side by side, which
// hides the latency of the square root and the division.
#pragma once

#include "integration/kernels/block.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include <spring_pendulum/integration/butcher_tableau.hpp>

#include <cstddef>
#include <utility>

namespace spring_pendulum {
namespace {

/// Which slopes a stage's result needs is known to the compiler; their weights, which contain the
/// step, are not.
template <const ButcherTableau& kTableau, bool kDamped, bool kGravity>
class Conveyor {
 public:
  Conveyor(const KernelChain& chain, const StepWeights& weights, double* state, double* workspace)
      : chain_(chain),
        weights_(weights),
        state_(state),
        workspace_(workspace),
        blocks_(blocksOf(chain.size)) {}

  void step() { step(std::make_index_sequence<kTableau.stages>()); }

 private:
  static constexpr std::size_t kStages = kTableau.stages;
  static constexpr std::ptrdiff_t kBlocksBetweenStages = 2;
  static constexpr std::ptrdiff_t kRing = ringBlocks(kStages);
  static constexpr std::ptrdiff_t kBlockNumbers = 4 * kLanes;

  template <std::size_t... kStage>
  void step(std::index_sequence<kStage...> /*stages*/) {
    for (std::size_t i = 0; i < kStages; ++i) {
      Pack{}.store(forcesOf(i));
      Pack{}.store(forcesOf(i) + kLanes);
    }
    if (blocks_ <= kRing) return (wholeStage<kStage>(), ...);
    const std::ptrdiff_t ticks = blocks_ + kBlocksBetweenStages * (kStages - 1);
    for (std::ptrdiff_t tick = 0; tick < ticks; ++tick) {
      (stageOfTick<kStages - 1 - kStage>(tick), ...);
    }
  }

  template <std::size_t kStage>
  void wholeStage() {
    for (std::ptrdiff_t block = 0; block < blocks_; ++block) stage<kStage>(block);
  }

  template <std::size_t kStage>
  [[gnu::always_inline]] void stageOfTick(std::ptrdiff_t tick) {
    const std::ptrdiff_t block = tick - kBlocksBetweenStages * kStage;
    if (block >= 0 && block < blocks_) stage<kStage>(block);
  }

  template <std::size_t kStage>
  [[gnu::always_inline]] void stage(std::ptrdiff_t block) {
    const Block here = load(stateOf(kStage, block));
    const Block next = load(stateOf(kStage, block + 1 < blocks_ ? block + 1 : block));
    double* const carried = forcesOf(kStage);
    const PlaneVector<Pack> before{Pack::load(carried), Pack::load(carried + kLanes)};
    const PlaneVector<Pack> forces = forcesFromRight<kDamped>(chain_, here, next, block);
    forces.x.store(carried);
    forces.y.store(carried + kLanes);
    const Block slope = slopeOf<kGravity>(chain_, here, before, forces, block);
    Block result = load({state_ + block * kLanes, chain_.pitch});
    result = plusEarlierSlopes<kStage>(result, block, std::make_index_sequence<kStage>());
    if constexpr (coefficient(kStage, kStage) != 0.0) {
      result = plusWeighted(result, weights_.after[kStage][kStage], slope);
    }
    if constexpr (kStage + 1 < kStages) {
      store(slope, {slopesOf(kStage) + inRing(block), kLanes});
      store(result, {statesOf(kStage + 1) + inRing(block), kLanes});
    } else {
      store(result, {state_ + block * kLanes, chain_.pitch});
    }
  }

  template <std::size_t kStage, std::size_t... kEarlier>
  [[gnu::always_inline]] Block plusEarlierSlopes(Block result,
                                                 [[maybe_unused]] std::ptrdiff_t block,
                                                 std::index_sequence<kEarlier...> /*stages*/) {
    ((result = plusEarlierSlope<kStage, kEarlier>(result, block)), ...);
    return result;
  }

  template <std::size_t kStage, std::size_t kEarlier>
  [[gnu::always_inline]] Block plusEarlierSlope(const Block& result, std::ptrdiff_t block) {
    if constexpr (coefficient(kStage, kEarlier) == 0.0) return result;
    const Block slope = load({slopesOf(kEarlier) + inRing(block), kLanes});
    return plusWeighted(result, weights_.after[kStage][kEarlier], slope);
  }

  /// Of slope `earlier` in the state that follows `stage`.
  static constexpr double coefficient(std::size_t stage, std::size_t earlier) {
    return stage + 1 < kStages ? kTableau.a[stage + 1][earlier] : kTableau.b[earlier];
  }

  /// A stage's workspace: a ring of blocks with its slopes, one with its states, and the forces of
  /// the springs of the block before.
  double* slopesOf(std::size_t stage) const {
    return workspace_ +
           static_cast<std::ptrdiff_t>(stage) * (2 * kRing * kBlockNumbers + 2 * kLanes);
  }
  double* statesOf(std::size_t stage) const { return slopesOf(stage) + kRing * kBlockNumbers; }
  double* forcesOf(std::size_t stage) const { return statesOf(stage) + kRing * kBlockNumbers; }
  static std::ptrdiff_t inRing(std::ptrdiff_t block) {
    return (block & (kRing - 1)) * kBlockNumbers;
  }

  [[gnu::always_inline]] BlockPlace<const double> stateOf(std::size_t stage,
                                                          std::ptrdiff_t block) const {
    if (stage == 0) return {state_ + block * kLanes, chain_.pitch};
    return {statesOf(stage) + inRing(block), kLanes};
  }

  const KernelChain chain_;  ///< a copy, which writing a state can not change
  const StepWeights& weights_;
  double* state_;
  double* workspace_;
  std::ptrdiff_t blocks_;
};

template <const ButcherTableau& kTableau, bool kDamped, bool kGravity>
void advance(const KernelChain& chain, const StepWeights& weights, std::ptrdiff_t steps,
             double* state, double* workspace) {
  Conveyor<kTableau, kDamped, kGravity> conveyor(chain, weights, state, workspace);
  for (std::ptrdiff_t n = 0; n < steps; ++n) conveyor.step();
}

template <const ButcherTableau& kTableau>
AdvanceKernel advanceKernelFor(bool damped, bool gravity) {
  if (damped) return gravity ? advance<kTableau, true, true> : advance<kTableau, true, false>;
  return gravity ? advance<kTableau, false, true> : advance<kTableau, false, false>;
}

AdvanceKernel advanceKernel(const ButcherTableau& tableau, bool damped, bool gravity) {
  if (&tableau == &kEulerTableau) return advanceKernelFor<kEulerTableau>(damped, gravity);
  if (&tableau == &kMidpointTableau) return advanceKernelFor<kMidpointTableau>(damped, gravity);
  if (&tableau == &kClassicalRungeKuttaTableau) {
    return advanceKernelFor<kClassicalRungeKuttaTableau>(damped, gravity);
  }
  return nullptr;
}

}  // namespace
}  // namespace spring_pendulum
