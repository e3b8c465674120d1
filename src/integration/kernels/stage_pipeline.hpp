// Whole steps of an explicit Runge-Kutta method, in place, with the data between the stages in the
// first-level cache.
//
// A long chain is divided into tiles, and each stage of a tile is completed before the next. Stage
// i of a block depends on stage i-1 of that block and of its two neighbours. So every stage stops
// one block before the end of the previous stage, and continues there in the next tile. The order
// is from the free end to the fixed particle, because the springs of a block need the block to the
// left, and its particles the springs to the right. Short chains are kept in registers if they fit.
//
// The loop is software pipelined. Each iteration does the two phases of a stage for two blocks, so that
// neither waits for the divider:
//
//     begin    block b            lengths of the springs
//     finish   block b + 5        forces, slope, state of the next stage
//
// Only the lengths wait in memory. The last phase computes the separations again, which takes less time
// than to store and load them.
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

/// Whether each stage uses the slope of the stage before it alone, so that no slope need be kept.
constexpr bool usesLastSlopesOnly(const ButcherTableau& tableau) {
  for (std::size_t i = 2; i < tableau.stages; ++i)
    for (std::size_t j = 0; j + 1 < i; ++j)
      if (tableau.a[i][j] != 0.0) return false;
  return true;
}

/// The tableau is a template parameter, so the compiler knows which coefficients are zero. The
/// weights, which contain the step size, are known only at run time.
template <const ButcherTableau& kTableau, bool kDamped, bool kDissipation>
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

  // Inlined, so that the compiler keeps constants in registers instead of reading them again after
  // every store.
  [[gnu::always_inline]] void advance(std::ptrdiff_t steps) {
    if (blocks_ <= kShortBlocks) return shortSteps(steps, std::make_index_sequence<kShortBlocks>());
    longSteps(steps, std::make_index_sequence<kTableau.stages>());
  }

 private:
  static constexpr std::ptrdiff_t kShortBlocks = 5;  ///< unrolled up to there
  static constexpr auto kStages = static_cast<std::ptrdiff_t>(kTableau.stages);
  static constexpr std::ptrdiff_t kTile = kTileParticles / kLanes;  ///< blocks of the shortest tile
  static constexpr std::ptrdiff_t kLead = 5;  ///< blocks from the first to the last phase
  static_assert(kShortBlocks >= kLead, "a stage begins after the blocks that it needs");
  static_assert(kTile >= 2 * kLead, "the next tile begins clear of the blocks that wait");
  static_assert(kTableau.stages <= StepWeights::kMostStages && usesLastSlopesOnly(kTableau));

  struct Springs {
    PlaneVector<Pack> separation;
    Pack inverse_length, dot;
  };

  /// What the last phase of a block keeps for the block to its left.
  struct Finished {
    Block left;                  ///< state of the block to the left
    PlaneVector<Pack> forces{};  ///< of the springs of the block
  };

  /// The blocks begin <= b < end of a tile or of a stage in it.
  struct Span {
    std::ptrdiff_t begin, end;
    double* workspace;  ///< where the first column would have block 0
  };

  template <std::size_t... kStage>
  [[gnu::always_inline]] void longSteps(std::ptrdiff_t steps,
                                        std::index_sequence<kStage...> /*stages*/) {
    const Block fixed = load(placeOf<const double>(state_, chain_.pitch, -1));
    const std::ptrdiff_t tiles = blocks_ < kTile ? 1 : blocks_ / kTile;
    Span waiting{};
    Finished last{};
    for (std::ptrdiff_t n = 0; n < steps; ++n) {
      for (std::ptrdiff_t i = tiles - 1; i >= 0; --i) {
        const Span tile{i * kTile, i + 1 == tiles ? blocks_ : (i + 1) * kTile,
                        workspace_ + (8 - i * kTile * kLanes)};
        if (tile.end < blocks_) keepBorder(waiting.workspace, tile);
        if (i == 0) store(fixed, placeIn(tile.workspace, kAt, -1));
        (stageOf<kStage>(tile, waiting, last), ...);
      }
    }
    for (std::ptrdiff_t block = kLead - 1; block >= 0; --block) {
      finish<kStages - 1, true>(waiting.workspace, block, last);
    }
  }

  /// Keeps the blocks of the tile to the right that lack later stages.
  [[gnu::always_inline]] static void keepBorder(const double* old_workspace, const Span& tile) {
    for (std::ptrdiff_t column = kAt; column < kColumns; ++column) {
      for (std::ptrdiff_t block = tile.end; block < tile.end + kStages - 1; ++block) {
        const std::ptrdiff_t at = column * kPitch + block * kLanes;
        Pack::load(old_workspace + at).store(tile.workspace + at);
      }
    }
  }

  /// A stage of a tile. It also finishes the last `kLead` blocks of the stage before; its own wait.
  template <std::ptrdiff_t kStage>
  [[gnu::always_inline]] void stageOf(const Span& tile, Span& waiting, Finished& last) {
    constexpr std::ptrdiff_t kPrevious = (kStage + kStages - 1) % kStages;
    double* const workspace = tile.workspace;
    const bool rightmost = tile.end == blocks_;
    const Span span{tile.begin == 0 ? 0 : tile.begin + kStage,
                    rightmost ? blocks_ : tile.end + kStage, workspace};
    std::ptrdiff_t block = span.end - 1;
    const Block rightmost_block = load(stateOf<kStage>(workspace, block));
    PlaneVector<Pack> here{rightmost_block.x, rightmost_block.y};
    for (std::ptrdiff_t i = 0; i < kLead; ++i, --block) {
      if (waiting.workspace != nullptr) {
        finish<kPrevious, true>(waiting.workspace, waiting.begin + kLead - 1 - i, last);
      }
      begin<kStage>(workspace, block, here);
    }
    waiting = span;
    store(last.forces, forcesOf(kPrevious));
    last = {load(stateOf<kStage>(workspace, span.end - 1)),
            rightmost ? PlaneVector<Pack>{} : load(forcesOf(kStage))};
    finish<kStage, false>(workspace, span.end - 1, last);
    begin<kStage>(workspace, block, here);
    for (--block; block >= span.begin; --block) {
      finish<kStage, true>(workspace, block + kLead, last);
      begin<kStage>(workspace, block, here);
    }
  }

  /// A block of a short chain, which the compiler keeps in registers where these suffice.
  struct ShortBlock {
    Block state, sum, at, slope;
    Springs springs;
    PlaneVector<Pack> forces;
  };

  /// Calls `shortStepsOf` for the number of blocks of the chain.
  template <std::size_t... kCount>
  void shortSteps(std::ptrdiff_t steps, std::index_sequence<kCount...> /*counts*/) {
    (void)((blocks_ == static_cast<std::ptrdiff_t>(kCount) + 1 &&
            (shortStepsOf(steps, std::make_index_sequence<kCount + 1>()), true)) ||
           ...);
  }

  template <std::size_t... kBlock>
  [[gnu::noinline]] void shortStepsOf(std::ptrdiff_t steps, std::index_sequence<kBlock...> blocks) {
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

  [[gnu::always_inline]] static Springs springsBetween(const Block& left, const Block& here) {
    Springs springs{};
    springs.separation = separationsOf(left, here);
    springs.inverse_length = inverseLength(springs.separation);
    if constexpr (kDamped) {
      springs.dot = dotProduct(relativeVelocitiesOf(left, here), springs.separation);
    }
    return springs;
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
    ((chain[kBlock].slope = slopeOf<(kBlock < kLast)>(
          chain_, chain[kBlock].at, chain[kBlock].forces,
          kBlock < kLast ? chain[kBlock < kLast ? kBlock + 1 : kLast].forces : PlaneVector<Pack>{},
          kBlock)),
     ...);
    ((chain[kBlock].sum = sumAfter<kStage>(chain[kBlock].sum, chain[kBlock].slope)), ...);
    ((chain[kBlock].at = nextStage<kStage>(chain[kBlock].state, chain[kBlock].slope)), ...);
  }

  /// First phase of a stage.
  /// \param here columns x and y of the block; becomes those of the block to the left
  template <std::ptrdiff_t kStage>
  [[gnu::always_inline]] void begin(double* workspace, std::ptrdiff_t block,
                                    PlaneVector<Pack>& here) {
    const BlockPlace<double> at = stateOf<kStage>(workspace, block);
    const PlaneVector<Pack> left{Pack::load(at.first - kLanes),
                                 Pack::load(at.first + at.pitch - kLanes)};
    const PlaneVector<Pack> separation{here.x - leftNeighbours(left.x, here.x),
                                       here.y - leftNeighbours(left.y, here.y)};
    inverseLength(separation).store(placeIn(workspace, kLengths, block).first);
    here = left;
  }

  /// Last phase: forces, slope, and the state of the next stage or the end of the step.
  /// \tparam kInner whether there is a block to the right
  template <std::ptrdiff_t kStage, bool kInner>
  [[gnu::always_inline]] void finish(double* workspace, std::ptrdiff_t block, Finished& last) {
    const BlockPlace<double> at = stateOf<kStage>(workspace, block);
    Block here, left;
    if constexpr (kLanes < 8) {  // too few registers to keep a block for the next call
      here = load(at);
      left = {Pack::loadUnaligned(at.first - 1), Pack::loadUnaligned(at.first + at.pitch - 1),
              Pack::loadUnaligned(at.first + 2 * at.pitch - 1),
              Pack::loadUnaligned(at.first + 3 * at.pitch - 1)};
    } else {  // an unaligned load would always cross a cache line
      here = last.left;
      last.left = load(BlockPlace<double>{at.first - kLanes, at.pitch});
      left = leftNeighbours(last.left, here);
    }
    Springs springs{};
    springs.separation = {here.x - left.x, here.y - left.y};
    springs.inverse_length = Pack::load(placeIn(workspace, kLengths, block).first);
    const PlaneVector<Pack> relative_velocity{here.vx - left.vx, here.vy - left.vy};
    if constexpr (kDamped) springs.dot = dotProduct(relative_velocity, springs.separation);
    const PlaneVector<Pack> forces = forcesFrom<kStage, kInner>(springs, block);
    const Block slope = slopeOf<kInner>(chain_, here, forces, last.forces, block);
    last.forces = forces;
    const BlockPlace<double> place = placeOf(state_, chain_.pitch, block);
    const Block start = load(place);
    const Block sum =
        sumAfter<kStage>(kStage == 0 ? start : load(placeIn(workspace, kSum, block)), slope);
    if constexpr (kStage + 1 == kStages) {
      store(sum, place);
    } else {
      store(sum, placeIn(workspace, kSum, block));
      store(nextStage<kStage>(start, slope), placeIn(workspace, kAt, block));
    }
  }

  /// Adds the slope of a stage to the sum that becomes the end of the step.
  template <std::size_t kStage>
  [[gnu::always_inline]] Block sumAfter(const Block& sum, const Block& slope) const {
    return kTableau.b[kStage] == 0.0 ? sum : plusWeighted(sum, weights_.sum[kStage], slope);
  }

  /// Returns the state of the stage after kStage; undefined after the last one.
  template <std::size_t kStage>
  [[gnu::always_inline]] Block nextStage(const Block& start, const Block& slope) const {
    if constexpr (kStage + 1 == kTableau.stages) return {};
    return plusWeighted(start, weights_.next[kStage], slope);
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

  /// Columns of the workspace: lengths of springs; four for the state of the next stage, and four for
  /// the sum up to there.
  static constexpr std::ptrdiff_t kLengths = 0, kAt = 1, kSum = 5, kColumns = 9;
  static constexpr std::ptrdiff_t kPitch = tilePitch(kTableau.stages);

  [[gnu::always_inline]] static BlockPlace<double> placeIn(double* workspace, std::ptrdiff_t column,
                                                           std::ptrdiff_t block) {
    return {workspace + column * kPitch + block * kLanes, kPitch};
  }
  template <std::ptrdiff_t kStage>
  [[gnu::always_inline]] BlockPlace<double> stateOf(double* workspace, std::ptrdiff_t block) const {
    return kStage == 0 ? placeOf(state_, chain_.pitch, block) : placeIn(workspace, kAt, block);
  }
  /// The forces of the first springs of the tile to the right.
  [[gnu::always_inline]] double* forcesOf(std::ptrdiff_t stage) const {
    return workspace_ + kColumns * kPitch + 2 * kLanes * stage;
  }

  const KernelChain chain_;  ///< copy: through a reference it would be reloaded after every store
  const StepWeights weights_;
  double* const state_;
  double* const dissipated_;
  double* const workspace_;
  const std::ptrdiff_t blocks_;
};

}  // namespace
}  // namespace spring_pendulum
