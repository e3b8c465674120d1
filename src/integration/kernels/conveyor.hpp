// Whole steps of an explicit Runge-Kutta method in one pass over the chain, in place.
//
// Stage i of a block depends only on stage i-1 of that block and of its two neighbours. So all
// stages move along the chain together, each some blocks behind the one before it, and the data
// between them stays in the first-level cache. Each stage is split in two halves. The first ends
// with the square root and the division; the second uses their result a tick later, so it does not
// wait for the divider.
//
//     tick t:   stage 1 of blocks t and t-1,  stage 2 of t-3 and t-4,  ...  stage 4 of t-9 and t-10
//
// The halves of one tick do not depend on each other. Chains of up to four blocks are kept in
// registers where these suffice. Chains that fit the ring buffers complete each stage before the
// next.
#pragma once

#include "integration/kernels/block.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/fast_tableaus.hpp"
#include <spring_pendulum/integration/butcher_tableau.hpp>

#include <cstddef>
#include <iterator>
#include <utility>

namespace spring_pendulum {
namespace {

/// The tableau is a template parameter, so the compiler knows which coefficients are zero. The
/// weights, which contain the step size, are known only at run time.
template <const ButcherTableau& kTableau, bool kDamped, bool kGravity, bool kDissipation>
class Conveyor {
 public:
  Conveyor(const KernelChain& chain, const StepWeights& weights, double* state, double* dissipated,
           double* workspace)
      : chain_(chain),
        weights_(weights),
        state_(state),
        dissipated_(dissipated),
        workspace_(workspace),
        blocks_(blocksOf(chain.size)) {}

  bool isShort() const { return blocks_ <= 4; }

  void advanceShort(std::ptrdiff_t steps) {
    if (blocks_ == 1) return shortSteps(steps, std::make_index_sequence<1>());
    if (blocks_ == 2) return shortSteps(steps, std::make_index_sequence<2>());
    if (blocks_ == 3) return shortSteps(steps, std::make_index_sequence<3>());
    return shortSteps(steps, std::make_index_sequence<4>());
  }

  void advance(std::ptrdiff_t steps) {
    for (std::ptrdiff_t n = 0; n < steps; ++n) step(std::make_index_sequence<kTableau.stages>());
  }

 private:
  static constexpr auto kStages = static_cast<std::ptrdiff_t>(kTableau.stages);
  /// Ticks between the halves of a stage, so that about four halves of other stages run meanwhile.
  static constexpr std::ptrdiff_t kLag = (3 + kStages) / kStages;
  /// The same distance, in blocks, where one stage runs alone.
  static constexpr std::ptrdiff_t kLead = 4;
  static constexpr std::ptrdiff_t kBlocksBetweenStages = kLag + 2;
  /// Ticks until the last stage finishes its first block.
  static constexpr std::ptrdiff_t kFill = kBlocksBetweenStages * (kStages - 1) + kLag;
  static constexpr std::ptrdiff_t kBlockNumbers = 4 * kLanes;

  /// Whether a stage later than j + 1 needs slope j.
  static constexpr bool keepsSlope(std::ptrdiff_t j) {
    const auto slope = static_cast<std::size_t>(j);
    for (std::size_t i = slope + 2; i < kTableau.stages; ++i) {
      if (kTableau.a[i][slope] != 0.0) return true;
    }
    return false;
  }
  static constexpr bool keepsSlopes() {
    for (std::ptrdiff_t j = 0; j < kStages; ++j) {
      if (keepsSlope(j)) return true;
    }
    return false;
  }
  /// Results of the first half of a stage.
  struct Springs {
    PlaneVector<Pack> separation;
    Pack inverse_length, dot;
  };

  static constexpr std::ptrdiff_t kRing = keepsSlopes() ? ringBlocks(kStages) : 8;

  template <std::size_t... kStage>
  void step(std::index_sequence<kStage...> /*stages*/) {
    for (std::ptrdiff_t i = 0; i < kStages; ++i) {
      Pack{}.store(forcesOf(i));
      Pack{}.store(forcesOf(i) + kLanes);
    }
    if (blocks_ <= kRing) return (wholeStage<kStage>(), ...);
    std::ptrdiff_t tick = 0;
    for (; tick <= kFill; ++tick) (halves<kStage>(tick), ...);
    for (; tick < blocks_ - 1; ++tick) (innerHalves<kStage>(tick), ...);
    for (; tick < blocks_ + kFill; ++tick) (halves<kStage>(tick), ...);
  }

  /// A block of a short chain, which the compiler keeps in registers where these suffice.
  struct ShortBlock {
    Block state, sum, at, slope;
    Springs springs;
    PlaneVector<Pack> forces;
    Block slopes[keepsSlopes() ? kStages : 1];
  };

  template <std::size_t... kBlock>
  void shortSteps(std::ptrdiff_t steps, std::index_sequence<kBlock...> blocks) {
    ShortBlock chain[sizeof...(kBlock)];
    ((chain[kBlock].state = load({state_ + kBlock * kLanes, chain_.pitch})), ...);
    for (std::ptrdiff_t n = 0; n < steps; ++n) {
      ((chain[kBlock].at = chain[kBlock].sum = chain[kBlock].state), ...);
      shortStages(chain, blocks, std::make_index_sequence<kTableau.stages>());
      ((chain[kBlock].state = chain[kBlock].sum), ...);
    }
    (store(chain[kBlock].state, {state_ + kBlock * kLanes, chain_.pitch}), ...);
  }

  template <std::size_t... kBlock, std::size_t... kStage>
  [[gnu::always_inline]] void shortStages(ShortBlock* chain, std::index_sequence<kBlock...> blocks,
                                          std::index_sequence<kStage...> /*stages*/) {
    (shortStage<kStage>(chain, blocks), ...);
  }

  template <std::size_t kStage, std::size_t... kBlock>
  [[gnu::always_inline]] void shortStage(ShortBlock* chain, std::index_sequence<kBlock...>) {
    constexpr std::size_t kLast = sizeof...(kBlock) - 1;
    ((chain[kBlock].springs =
          springsBetween(chain[kBlock].at, chain[kBlock < kLast ? kBlock + 1 : kLast].at)),
     ...);
    ((chain[kBlock].forces = forcesFrom<kStage, (kBlock < kLast)>(chain[kBlock].springs, kBlock)),
     ...);
    ((chain[kBlock].slope = slopeOf<kGravity>(
          chain_, chain[kBlock].at,
          kBlock > 0 ? chain[kBlock > 0 ? kBlock - 1 : 0].forces : PlaneVector<Pack>{},
          chain[kBlock].forces, kBlock)),
     ...);
    (shortResult<kStage>(chain[kBlock], std::make_index_sequence<kStage>()), ...);
  }

  template <std::size_t kStage, std::size_t... kEarlier>
  [[gnu::always_inline]] void shortResult(ShortBlock& block, std::index_sequence<kEarlier...>) {
    if constexpr (kTableau.b[kStage] != 0.0) {
      block.sum = plusWeighted(block.sum, weights_.after[kStages - 1][kStage], block.slope);
    }
    if constexpr (kStage + 1 < kStages) {
      block.at = block.state;
      (addEarlierSlope<kStage, kEarlier>(block), ...);
      if constexpr (kTableau.a[kStage + 1][kStage] != 0.0) {
        block.at = plusWeighted(block.at, weights_.after[kStage][kStage], block.slope);
      }
      if constexpr (keepsSlope(kStage)) block.slopes[kStage] = block.slope;
    }
  }

  template <std::size_t kStage, std::size_t kEarlier>
  [[gnu::always_inline]] void addEarlierSlope(ShortBlock& block) {
    if constexpr (kTableau.a[kStage + 1][kEarlier] != 0.0) {
      block.at = plusWeighted(block.at, weights_.after[kStage][kEarlier], block.slopes[kEarlier]);
    }
  }

  template <std::ptrdiff_t kStage>
  void wholeStage() {
    for (std::ptrdiff_t block = 0; block < blocks_ + kLead; ++block) {
      if (block >= kLead) finish<kStage, false>(block - kLead);
      if (block < blocks_) begin<kStage, false>(block);
    }
  }

  template <std::ptrdiff_t kStage>
  [[gnu::always_inline]] void halves(std::ptrdiff_t tick) {
    const std::ptrdiff_t block = tick - kBlocksBetweenStages * kStage;
    if (block >= kLag && block - kLag < blocks_) finish<kStage, false>(block - kLag);
    if (block >= 0 && block < blocks_) begin<kStage, false>(block);
  }

  template <std::ptrdiff_t kStage>
  [[gnu::always_inline]] void innerHalves(std::ptrdiff_t tick) {
    const std::ptrdiff_t block = tick - kBlocksBetweenStages * kStage;
    finish<kStage, true>(block - kLag);
    begin<kStage, true>(block);
  }

  /// First half of a stage: separations and inverse lengths of the springs.
  template <std::ptrdiff_t kStage, bool kInner>
  [[gnu::always_inline]] void begin(std::ptrdiff_t block) {
    const Block here = load(stateOf(kStage, block));
    const Block next = load(stateOf(kStage, kInner || block + 1 < blocks_ ? block + 1 : block));
    const Springs springs = springsBetween(here, next);
    double* const to = springsOf(kStage) + inRing(block);
    springs.separation.x.store(to);
    springs.separation.y.store(to + kLanes);
    springs.inverse_length.store(to + 2 * kLanes);
    if constexpr (kDamped) springs.dot.store(to + 3 * kLanes);
  }

  [[gnu::always_inline]] static Springs springsBetween(const Block& here, const Block& next) {
    Springs springs{};
    springs.separation = {rightNeighbours(here.x, next.x) - here.x,
                          rightNeighbours(here.y, next.y) - here.y};
    springs.inverse_length = inverseSquareRoot(squaredLength(springs.separation));
    if constexpr (kDamped) {
      const PlaneVector<Pack> approach{rightNeighbours(here.vx, next.vx) - here.vx,
                                       rightNeighbours(here.vy, next.vy) - here.vy};
      springs.dot = dotProduct(approach, springs.separation);
    }
    return springs;
  }

  /// Second half of a stage: forces, slope, and the state of the next stage or the end of the step.
  template <std::ptrdiff_t kStage, bool kInner>
  [[gnu::always_inline]] void finish(std::ptrdiff_t block) {
    const double* const from = springsOf(kStage) + inRing(block);
    Springs springs{
        {Pack::load(from), Pack::load(from + kLanes)}, Pack::load(from + 2 * kLanes), {}};
    if constexpr (kDamped) springs.dot = Pack::load(from + 3 * kLanes);
    const PlaneVector<Pack> forces = forcesFrom<kStage, kInner>(springs, block);
    double* const carried = forcesOf(kStage);
    const PlaneVector<Pack> before{Pack::load(carried), Pack::load(carried + kLanes)};
    forces.x.store(carried);
    forces.y.store(carried + kLanes);
    const BlockPlace<const double> at = stateOf(kStage, block);
    const Block here{
        {}, {}, Pack::load(at.first + 2 * at.pitch), Pack::load(at.first + 3 * at.pitch)};
    const Block slope = slopeOf<kGravity, kInner>(chain_, here, before, forces, block);
    const BlockPlace<double> place{state_ + block * kLanes, chain_.pitch};
    Block sum = kStage == 0 ? load({place.first, place.pitch})
                            : load({sumsOf(kStage) + inRing(block), kLanes});
    if constexpr (kTableau.b[kStage] != 0.0) {
      sum = plusWeighted(sum, weights_.after[kStages - 1][kStage], slope);
    }
    if constexpr (kStage + 1 == kStages) {
      store(sum, place);
    } else {
      store(sum, {sumsOf(kStage + 1) + inRing(block), kLanes});
      Block result = load({place.first, place.pitch});
      result = plusEarlierSlopes<kStage>(result, block, std::make_index_sequence<kStage>());
      if constexpr (kTableau.a[kStage + 1][kStage] != 0.0) {
        result = plusWeighted(result, weights_.after[kStage][kStage], slope);
      }
      store(result, {statesOf(kStage + 1) + inRing(block), kLanes});
      if constexpr (keepsSlope(kStage)) store(slope, {slopesOf(kStage) + inRing(block), kLanes});
    }
  }

  template <std::ptrdiff_t kStage, bool kInner>
  [[gnu::always_inline]] PlaneVector<Pack> forcesFrom(const Springs& springs,
                                                      std::ptrdiff_t block) {
    PlaneVector<Pack> forces;
    if constexpr (kDamped) {
      forces = springForce(chain_.spring, springs.separation, springs.dot, springs.inverse_length);
      if constexpr (kDissipation && kTableau.b[kStage] != 0.0) {
        addDissipation(weights_.dissipation[kStage], springs.dot * springs.inverse_length,
                       dissipated_ + block * kLanes);
      }
    } else {
      forces = undampedSpringForce(chain_.spring, springs.separation, springs.inverse_length);
    }
    const std::ptrdiff_t springs_left = chain_.size - 1 - block * kLanes;
    if (!kInner && springs_left < kLanes) {
      forces = {only(forces.x, 0, springs_left), only(forces.y, 0, springs_left)};
    }
    return forces;
  }

  template <std::ptrdiff_t kStage, std::size_t... kEarlier>
  [[gnu::always_inline]] Block plusEarlierSlopes(Block result,
                                                 [[maybe_unused]] std::ptrdiff_t block,
                                                 std::index_sequence<kEarlier...> /*stages*/) {
    ((result = plusEarlierSlope<kStage, kEarlier>(result, block)), ...);
    return result;
  }

  template <std::ptrdiff_t kStage, std::size_t kEarlier>
  [[gnu::always_inline]] Block plusEarlierSlope(const Block& result, std::ptrdiff_t block) {
    if constexpr (kTableau.a[kStage + 1][kEarlier] == 0.0) return result;
    const Block slope = load({slopesOf(kEarlier) + inRing(block), kLanes});
    return plusWeighted(result, weights_.after[kStage][kEarlier], slope);
  }

  /// Workspace of a stage: ring buffers of blocks, then the spring forces of the previous block.
  static constexpr std::ptrdiff_t kRingNumbers = kRing * kBlockNumbers;
  double* statesOf(std::ptrdiff_t stage) const {
    return workspace_ + stage * (4 * kRingNumbers + 2 * kLanes);
  }
  double* sumsOf(std::ptrdiff_t stage) const { return statesOf(stage) + kRingNumbers; }
  double* springsOf(std::ptrdiff_t stage) const { return statesOf(stage) + 2 * kRingNumbers; }
  double* slopesOf(std::ptrdiff_t stage) const { return statesOf(stage) + 3 * kRingNumbers; }
  double* forcesOf(std::ptrdiff_t stage) const { return statesOf(stage) + 4 * kRingNumbers; }
  static std::ptrdiff_t inRing(std::ptrdiff_t block) {
    return (block & (kRing - 1)) * kBlockNumbers;
  }

  [[gnu::always_inline]] BlockPlace<const double> stateOf(std::ptrdiff_t stage,
                                                          std::ptrdiff_t block) const {
    if (stage == 0) return {state_ + block * kLanes, chain_.pitch};
    return {statesOf(stage) + inRing(block), kLanes};
  }

  const KernelChain chain_;  ///< copy: through a reference it would be reloaded after every store
  const StepWeights weights_;
  double* const state_;
  double* const dissipated_;
  double* const workspace_;
  const std::ptrdiff_t blocks_;
};

template <const ButcherTableau& kTableau, bool kDamped, bool kGravity, bool kDissipation>
void advance(const KernelChain& chain, const StepWeights& weights, std::ptrdiff_t steps,
             double* state, double* dissipated, double* workspace) {
  Conveyor<kTableau, kDamped, kGravity, kDissipation> conveyor(chain, weights, state, dissipated,
                                                               workspace);
  if (!conveyor.isShort()) return conveyor.advance(steps);
  // Adding a gravity of 0 changes no bit and costs little time; this saves a compiled variant.
  Conveyor<kTableau, kDamped, true, kDissipation>(chain, weights, state, dissipated, workspace)
      .advanceShort(steps);
}

template <const ButcherTableau& kTableau>
AdvanceKernel advanceKernelFor(StepNeeds needs) {
  if (!needs.damping) {
    return needs.gravity ? advance<kTableau, false, true, false>
                         : advance<kTableau, false, false, false>;
  }
  if (needs.dissipation) {
    return needs.gravity ? advance<kTableau, true, true, true>
                         : advance<kTableau, true, false, true>;
  }
  return needs.gravity ? advance<kTableau, true, true, false>
                       : advance<kTableau, true, false, false>;
}

template <std::size_t... kIndex>
AdvanceKernel advanceKernelAt(std::size_t tableau, StepNeeds needs,
                              std::index_sequence<kIndex...> /*tableaus*/) {
  AdvanceKernel kernel = nullptr;
  ((kernel = kIndex == tableau ? advanceKernelFor<*kFastTableaus[kIndex]>(needs) : kernel), ...);
  return kernel;
}

AdvanceKernel advanceKernel(std::size_t tableau, StepNeeds needs) {
  return advanceKernelAt(tableau, needs, std::make_index_sequence<std::size(kFastTableaus)>());
}

}  // namespace
}  // namespace spring_pendulum
