// Whole steps of an explicit Runge-Kutta method in one pass over the chain, in place.
//
// Stage i of a block depends only on stage i-1 of that block and of its two neighbours. So the
// stages move along the chain as a wavefront, each some blocks behind the one before it, and the
// data between them stays in the first-level cache. The loop is software pipelined: the first phase
// of a stage ends with the square root and the division; the second uses their result in the next
// iteration t, so it does not wait for the divider.
//
//     t:   stage 1 of blocks t and t-1,  stage 2 of t-3 and t-4,  ...,  stage 4 of t-9 and t-10
//
// Here blocks are counted from the free end, because the springs of a block need the block to the
// left, and its particles the springs to the right. Short chains are kept in registers where these
// suffice. Chains whose workspace fits the first-level cache complete each stage before the next.
//
// References: G. Wellein and others, COMPSAC 2009, 579-586, doi:10.1109/COMPSAC.2009.82
// (wavefronts); M. Lam, PLDI 1988, 318-328, doi:10.1145/53990.54022 (software pipelining).
#pragma once

#include "integration/kernels/block.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include <spring_pendulum/integration/butcher_tableau.hpp>

#include <cstddef>
#include <utility>

namespace spring_pendulum {
namespace {

/// The part of `StepWeights` that a tableau uses. Copying all of it would take a quarter of the time
/// of a step of three particles.
template <const ButcherTableau& kTableau>
struct WeightsOf {
  explicit WeightsOf(const StepWeights& all) {
    for (std::size_t i = 0; i < kTableau.stages; ++i) {
      for (std::size_t j = 0; j <= i; ++j) after[i][j] = all.after[i][j];
      dissipation[i] = all.dissipation[i];
    }
  }

  double after[kTableau.stages][kTableau.stages];
  double dissipation[kTableau.stages];
};

/// The tableau is a template parameter, so the compiler knows which coefficients are zero. The
/// weights, which contain the step size, are known only at run time.
template <const ButcherTableau& kTableau, bool kDamped, bool kGravity, bool kDissipation>
class StagePipeline {
 public:
  StagePipeline(const KernelChain& chain, const StepWeights& weights, double* state,
                double* dissipated, double* workspace)
      : chain_(chain),
        weights_(weights),
        state_(state),
        dissipated_(dissipated),
        workspace_(workspace),
        blocks_(blocksOf(chain.size)) {}

  /// Whether a chain has so few blocks that its code is unrolled.
  static bool isShort(const KernelChain& chain) { return blocksOf(chain.size) <= kShortBlocks; }

  void advanceShort(std::ptrdiff_t steps) {
    shortSteps(steps, std::make_index_sequence<kShortBlocks>());
  }

  // Inlined, so that the compiler keeps constants in registers instead of reading them again after
  // every store.
  [[gnu::always_inline]] void advance(std::ptrdiff_t steps) {
    constexpr auto kAll = std::make_index_sequence<kTableau.stages>();
    if (blocks_ <= kWholeParticles / kLanes) return wholeSteps(steps, kAll);
    for (std::ptrdiff_t n = 0; n < steps; ++n) step(kAll);
  }

 private:
  /// Layout of the workspace: a record per block of the chain, or a ring of records per stage.
  enum class Memory { kWhole, kRings };

  static constexpr std::ptrdiff_t kShortBlocks = kLanes == 8 ? 4 : 5;  ///< unrolled up to there
  static constexpr auto kStages = static_cast<std::ptrdiff_t>(kTableau.stages);
  /// Iterations between the phases of a stage; about four phases of other stages run meanwhile.
  static constexpr std::ptrdiff_t kLag = (3 + kStages) / kStages;
  static constexpr std::ptrdiff_t kLead = 4;  ///< blocks between them where one stage runs alone
  static_assert(kShortBlocks + 1 > kLead, "wholeStage needs more than kLead blocks");
  static constexpr std::ptrdiff_t kBlocksBetweenStages = kLag + 2;
  /// Iterations until the last stage finishes its first block.
  static constexpr std::ptrdiff_t kPrologue = kBlocksBetweenStages * (kStages - 1) + kLag;
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
  /// Results of the first phase of a stage.
  struct Springs {
    PlaneVector<Pack> separation;
    Pack inverse_length, dot;
  };

  static constexpr std::ptrdiff_t kRing = keepsSlopes() ? ringBlocks(kStages) : 8;

  template <std::size_t... kStage>
  [[gnu::always_inline]] void step(std::index_sequence<kStage...> /*stages*/) {
    for (std::ptrdiff_t i = 0; i < kStages; ++i) {
      Pack{}.store(forcesOf(i));
      Pack{}.store(forcesOf(i) + kLanes);
    }
    std::ptrdiff_t t = 0;
    for (; t <= kPrologue; ++t) (iterateAtEnd<kStage>(t), ...);
    for (; t < blocks_ - 1; ++t) (iterateInside<kStage>(t), ...);
    for (; t < blocks_ + kPrologue; ++t) (iterateAtEnd<kStage>(t), ...);
  }

  /// Steps that complete each stage before the next. The last `kLead` second phases of a stage
  /// alternate with the first phases of the next one.
  template <std::size_t... kStage>
  [[gnu::always_inline]] void wholeSteps(std::ptrdiff_t steps,
                                         std::index_sequence<kStage...> /*stages*/) {
    const Block fixed = load(placeOf<const double>(state_, chain_.pitch, -1));
    store(fixed, {recordOf<Memory::kWhole>(0, -1), kLanes});
    PlaneVector<Pack> next_forces{};
    for (std::ptrdiff_t n = 0; n < steps; ++n) (wholeStage<kStage>(n > 0, next_forces), ...);
    for (std::ptrdiff_t block = kLead - 1; block >= 0; --block) {
      finish<kStages - 1, Memory::kWhole, true>(block, next_forces);
    }
  }

  template <std::ptrdiff_t kStage>
  [[gnu::always_inline]] void wholeStage(bool has_previous, PlaneVector<Pack>& next_forces) {
    constexpr std::ptrdiff_t kPrevious = (kStage + kStages - 1) % kStages;
    std::ptrdiff_t block = blocks_ - 1;
    for (std::ptrdiff_t last = kLead - 1; last >= 0; --last, --block) {
      if (kStage > 0 || has_previous) finish<kPrevious, Memory::kWhole, true>(last, next_forces);
      begin<kStage, Memory::kWhole, true>(block);
    }
    next_forces = {};
    finish<kStage, Memory::kWhole, false>(blocks_ - 1, next_forces);
    begin<kStage, Memory::kWhole, true>(block);
    for (--block; block >= 0; --block) {
      finish<kStage, Memory::kWhole, true>(block + kLead, next_forces);
      begin<kStage, Memory::kWhole, true>(block);
    }
  }

  /// A block of a short chain, which the compiler keeps in registers where these suffice.
  struct ShortBlock {
    Block state, sum, at, slope;
    Springs springs;
    PlaneVector<Pack> forces;
    Block slopes[keepsSlopes() ? kStages : 1];
  };

  /// Calls `shortStepsOf` for the number of blocks of the chain.
  template <std::size_t... kCount>
  void shortSteps(std::ptrdiff_t steps, std::index_sequence<kCount...> /*counts*/) {
    (void)((blocks_ == static_cast<std::ptrdiff_t>(kCount) + 1 &&
            (shortStepsOf(steps, std::make_index_sequence<kCount + 1>()), true)) ||
           ...);
  }

  template <std::size_t... kBlock>
  void shortStepsOf(std::ptrdiff_t steps, std::index_sequence<kBlock...> blocks) {
    ShortBlock chain[sizeof...(kBlock)];
    ((chain[kBlock].state = load(placeOf<const double>(state_, chain_.pitch, kBlock))), ...);
    for (std::ptrdiff_t n = 0; n < steps; ++n) {
      ((chain[kBlock].at = chain[kBlock].sum = chain[kBlock].state), ...);
      shortStages(chain, blocks, std::make_index_sequence<kTableau.stages>());
      ((chain[kBlock].state = chain[kBlock].sum), ...);
    }
    (store(chain[kBlock].state, placeOf(state_, chain_.pitch, kBlock)), ...);
  }

  template <std::size_t... kBlock, std::size_t... kStage>
  [[gnu::always_inline]] void shortStages(ShortBlock* chain, std::index_sequence<kBlock...> blocks,
                                          std::index_sequence<kStage...> /*stages*/) {
    (shortStage<kStage>(chain, blocks), ...);
  }

  template <std::size_t kStage, std::size_t... kBlock>
  [[gnu::always_inline]] void shortStage(ShortBlock* chain, std::index_sequence<kBlock...>) {
    constexpr std::size_t kLast = sizeof...(kBlock) - 1;
    const Block fixed = load(placeOf<const double>(state_, chain_.pitch, -1));
    ((chain[kBlock].springs = springsBetween(
          kBlock > 0 ? chain[kBlock > 0 ? kBlock - 1 : 0].at : fixed, chain[kBlock].at)),
     ...);
    ((chain[kBlock].forces = forcesFrom<kStage, (kBlock < kLast)>(chain[kBlock].springs, kBlock)),
     ...);
    ((chain[kBlock].slope = slopeOf<kGravity, (kBlock < kLast)>(
          chain_, chain[kBlock].at, chain[kBlock].forces,
          kBlock < kLast ? chain[kBlock < kLast ? kBlock + 1 : kLast].forces : PlaneVector<Pack>{},
          kBlock)),
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

  /// The phases of a stage in iteration t, where the stage may be past an end of the chain.
  template <std::ptrdiff_t kStage>
  [[gnu::always_inline]] void iterateAtEnd(std::ptrdiff_t t) {
    const std::ptrdiff_t begun = t - kBlocksBetweenStages * kStage;  // blocks before this one
    const std::ptrdiff_t block = blocks_ - 1 - begun;
    if (begun >= kLag && begun - kLag < blocks_) finish<kStage, false>(block + kLag);
    if (begun >= 0 && begun < blocks_) begin<kStage, Memory::kRings, false>(block);
  }

  template <std::ptrdiff_t kStage>
  [[gnu::always_inline]] void iterateInside(std::ptrdiff_t t) {
    const std::ptrdiff_t block = blocks_ - 1 - t + kBlocksBetweenStages * kStage;
    finish<kStage, true>(block + kLag);
    begin<kStage, Memory::kRings, true>(block);
  }

  /// First phase of a stage: separations and inverse lengths of the springs.
  /// \tparam kInner whether there is a block to the left
  template <std::ptrdiff_t kStage, Memory kMemory, bool kInner>
  [[gnu::always_inline]] void begin(std::ptrdiff_t block) {
    const Block here = load(stateOf<kStage, kMemory>(block));
    const Block left = load(kInner || block > 0 ? stateOf<kStage, kMemory>(block - 1)
                                                : placeOf<const double>(state_, chain_.pitch, -1));
    const Springs springs = springsBetween(left, here);
    double* const to = recordOf<kMemory>(kStage, block) + kSpringsAt;
    springs.separation.x.store(to);
    springs.separation.y.store(to + kLanes);
    springs.inverse_length.store(to + 2 * kLanes);
    if constexpr (kDamped) springs.dot.store(to + 3 * kLanes);
  }

  [[gnu::always_inline]] static Springs springsBetween(const Block& left, const Block& here) {
    Springs springs{};
    springs.separation = separationsOf(left, here);
    springs.inverse_length = inverseSquareRoot(squaredLength(springs.separation));
    if constexpr (kDamped)
      springs.dot = dotProduct(relativeVelocitiesOf(left, here), springs.separation);
    return springs;
  }

  /// Second phase of a stage: forces, slope, and the state of the next stage or the end of the step.
  /// \tparam kInner whether there is a block to the right
  template <std::ptrdiff_t kStage, bool kInner>
  [[gnu::always_inline]] void finish(std::ptrdiff_t block) {
    double* const carried = forcesOf(kStage);
    PlaneVector<Pack> next_forces{Pack::load(carried), Pack::load(carried + kLanes)};
    finish<kStage, Memory::kRings, kInner>(block, next_forces);
    next_forces.x.store(carried);
    next_forces.y.store(carried + kLanes);
  }

  template <std::ptrdiff_t kStage, Memory kMemory, bool kInner>
  [[gnu::always_inline]] void finish(std::ptrdiff_t block, PlaneVector<Pack>& next_forces) {
    double* const record = recordOf<kMemory>(kStage, block);
    double* const next_record = recordOf<kMemory>(kStage + 1, block);
    const double* const from = record + kSpringsAt;
    Springs springs{
        {Pack::load(from), Pack::load(from + kLanes)}, Pack::load(from + 2 * kLanes), {}};
    if constexpr (kDamped) springs.dot = Pack::load(from + 3 * kLanes);
    const PlaneVector<Pack> forces = forcesFrom<kStage, kInner>(springs, block);
    const BlockPlace<const double> at = stateOf<kStage, kMemory>(block);
    const Block here{
        {}, {}, Pack::load(at.first + 2 * at.pitch), Pack::load(at.first + 3 * at.pitch)};
    const Block slope = slopeOf<kGravity, kInner>(chain_, here, forces, next_forces, block);
    next_forces = forces;
    const BlockPlace<double> place = placeOf(state_, chain_.pitch, block);
    Block sum = kStage == 0 ? load({place.first, place.pitch}) : load({record + kSumAt, kLanes});
    if constexpr (kTableau.b[kStage] != 0.0) {
      sum = plusWeighted(sum, weights_.after[kStages - 1][kStage], slope);
    }
    if constexpr (kStage + 1 == kStages) {
      store(sum, place);
    } else {
      store(sum, {next_record + kSumAt, kLanes});
      Block result = load({place.first, place.pitch});
      result =
          plusEarlierSlopes<kStage, kMemory>(result, block, std::make_index_sequence<kStage>());
      if constexpr (kTableau.a[kStage + 1][kStage] != 0.0) {
        result = plusWeighted(result, weights_.after[kStage][kStage], slope);
      }
      store(result, {next_record, kLanes});
      if constexpr (keepsSlope(kStage)) store(slope, {slopeAt<kMemory>(kStage, block), kLanes});
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
    return kInner ? forces : onlySprings(forces, chain_, block);
  }

  template <std::ptrdiff_t kStage, Memory kMemory, std::size_t... kEarlier>
  [[gnu::always_inline]] Block plusEarlierSlopes(Block result,
                                                 [[maybe_unused]] std::ptrdiff_t block,
                                                 std::index_sequence<kEarlier...> /*stages*/) {
    ((result = plusEarlierSlope<kStage, kMemory, kEarlier>(result, block)), ...);
    return result;
  }

  template <std::ptrdiff_t kStage, Memory kMemory, std::size_t kEarlier>
  [[gnu::always_inline]] Block plusEarlierSlope(const Block& result, std::ptrdiff_t block) {
    if constexpr (kTableau.a[kStage + 1][kEarlier] == 0.0) return result;
    const Block slope = load({slopeAt<kMemory>(kEarlier, block), kLanes});
    return plusWeighted(result, weights_.after[kStage][kEarlier], slope);
  }

  /// Workspace of a block: its state at a stage, the sum up to there, its springs, and slopes.
  static constexpr std::ptrdiff_t kSumAt = kBlockNumbers;
  static constexpr std::ptrdiff_t kSpringsAt = 2 * kBlockNumbers;
  static constexpr std::ptrdiff_t kSlopesAt = 3 * kBlockNumbers;
  template <Memory kMemory>
  double* recordOf(std::ptrdiff_t stage, std::ptrdiff_t block) const {
    constexpr bool kWhole = kMemory == Memory::kWhole;
    constexpr std::ptrdiff_t kSlopes = !keepsSlopes() ? 0 : kWhole ? kStages : 1;
    constexpr std::ptrdiff_t kNumbers = kSlopesAt + kSlopes * kBlockNumbers;
    double* const first = workspace_ + 2 * kLanes * kStages;
    if (kWhole) return first + (block + 1) * kNumbers;
    return first + (stage * kRing + (block & (kRing - 1))) * kNumbers;
  }
  template <Memory kMemory>
  double* slopeAt(std::ptrdiff_t stage, std::ptrdiff_t block) const {
    return recordOf<kMemory>(stage, block) + kSlopesAt +
           (kMemory == Memory::kWhole ? stage * kBlockNumbers : 0);
  }
  /// The forces of the springs of the block to the right.
  double* forcesOf(std::ptrdiff_t stage) const { return workspace_ + 2 * kLanes * stage; }

  template <std::ptrdiff_t kStage, Memory kMemory>
  [[gnu::always_inline]] BlockPlace<const double> stateOf(std::ptrdiff_t block) const {
    if constexpr (kStage == 0) return placeOf<const double>(state_, chain_.pitch, block);
    return {recordOf<kMemory>(kStage, block), kLanes};
  }

  const KernelChain chain_;  ///< copy: through a reference it would be reloaded after every store
  const WeightsOf<kTableau> weights_;
  double* const state_;
  double* const dissipated_;
  double* const workspace_;
  const std::ptrdiff_t blocks_;
};

}  // namespace
}  // namespace spring_pendulum
