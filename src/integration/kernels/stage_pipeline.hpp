// Whole steps of an explicit Runge-Kutta method, in place, with the data between the stages in the
// first-level cache.
//
// A long chain is divided into tiles, and each stage of a tile is completed before the next. Stage
// i of a block depends on stage i-1 of that block and of its two neighbours. So every stage stops
// one block before the end of the previous stage, and continues there in the next tile. The order
// is from the free end to the fixed particle, because the springs of a block need the block to the
// left, and its particles the springs to the right. Short chains are kept in registers where these
// suffice.
//
// The loop is software pipelined. Each iteration does the three phases of a stage for three blocks,
// so that none of them waits for the divider:
//
//     begin    block b            separations and lengths of the springs
//     invert   block b + 2        inverse lengths: the division alone
//     finish   block b + 5        forces, slope, state of the next stage
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
    if (kLanes < 8 && blocks_ >= kUnalignedBlocks) return longSteps<true>(steps, kAll);
    longSteps<false>(steps, kAll);
  }

 private:
  static constexpr std::ptrdiff_t kShortBlocks = 5;  ///< unrolled up to there
  static constexpr auto kStages = static_cast<std::ptrdiff_t>(kTableau.stages);
  static constexpr std::ptrdiff_t kTile = kTileParticles / kLanes;  ///< blocks of the shortest tile
  static constexpr std::ptrdiff_t kLead = 5;        ///< blocks from the first to the last phase
  static constexpr std::ptrdiff_t kInvertLead = 2;  ///< blocks from the first to the middle phase
  static_assert(kShortBlocks >= kLead, "a stage begins after the blocks that it needs");
  static_assert(kTile >= 2 * kLead, "the next tile begins clear of the blocks that wait");
  /// AVX-512 gains nothing from a division apart, and loses by loads across cache lines.
  static constexpr bool kInvertsApart = kLanes < 8;
  /// Blocks from which on a load across two blocks does not wait for the stores of both.
  static constexpr std::ptrdiff_t kUnalignedBlocks = 12;

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

  /// The blocks begin <= b < end of a tile or of a stage in it.
  struct Span {
    std::ptrdiff_t begin, end;
    double* workspace;  ///< where the first column would have block 0
  };

  /// \tparam kUnaligned whether left neighbours are loaded from memory; else they are shuffled
  template <bool kUnaligned, std::size_t... kStage>
  [[gnu::always_inline]] void longSteps(std::ptrdiff_t steps,
                                        std::index_sequence<kStage...> /*stages*/) {
    const Block fixed = load(placeOf<const double>(state_, chain_.pitch, -1));
    const std::ptrdiff_t tiles = blocks_ < kTile ? 1 : blocks_ / kTile;
    Span waiting{};
    PlaneVector<Pack> next_forces{};
    for (std::ptrdiff_t n = 0; n < steps; ++n) {
      for (std::ptrdiff_t i = tiles - 1; i >= 0; --i) {
        const Span tile{i * kTile, i + 1 == tiles ? blocks_ : (i + 1) * kTile,
                        workspace_ + (8 - i * kTile * kLanes)};
        if (tile.end < blocks_) keepBorder(waiting.workspace, tile);
        if (i == 0) store(fixed, placeIn(tile.workspace, kAt, -1));
        (stageOf<kUnaligned, kStage>(tile, waiting, next_forces), ...);
      }
    }
    for (std::ptrdiff_t i = 0; i < kLead; ++i) finishWaiting<kStages - 1>(waiting, i, next_forces);
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
  template <bool kUnaligned, std::ptrdiff_t kStage>
  [[gnu::always_inline]] void stageOf(const Span& tile, Span& waiting,
                                      PlaneVector<Pack>& next_forces) {
    constexpr std::ptrdiff_t kPrevious = (kStage + kStages - 1) % kStages;
    double* const workspace = tile.workspace;
    const bool rightmost = tile.end == blocks_;
    const Span span{tile.begin == 0 ? 0 : tile.begin + kStage,
                    rightmost ? blocks_ : tile.end + kStage, workspace};
    std::ptrdiff_t block = span.end - 1;
    Block here = load(stateOf<kStage>(workspace, block));
    for (std::ptrdiff_t i = 0; i < kLead; ++i, --block) {
      if (waiting.workspace != nullptr) finishWaiting<kPrevious>(waiting, i, next_forces);
      if (i >= kInvertLead) invert(workspace, block + kInvertLead);
      begin<kUnaligned, kStage>(workspace, block, here);
    }
    waiting = span;
    store(next_forces, forcesOf(kPrevious));
    next_forces = rightmost ? PlaneVector<Pack>{} : load(forcesOf(kStage));
    finish<kStage, false>(workspace, span.end - 1, next_forces);
    invert(workspace, block + kInvertLead);
    begin<kUnaligned, kStage>(workspace, block, here);
    for (--block; block >= span.begin; --block) {
      finish<kStage, true>(workspace, block + kLead, next_forces);
      invert(workspace, block + kInvertLead);
      begin<kUnaligned, kStage>(workspace, block, here);
    }
  }

  /// Finishes the i-th block that waits.
  template <std::ptrdiff_t kStage>
  [[gnu::always_inline]] void finishWaiting(const Span& waiting, std::ptrdiff_t i,
                                            PlaneVector<Pack>& next_forces) {
    finish<kStage, true>(waiting.workspace, waiting.begin + kLead - 1 - i, next_forces);
    if (i < kInvertLead) invert(waiting.workspace, waiting.begin + kInvertLead - 1 - i);
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

  /// First phase of a stage.
  /// \param here state of the block; becomes that of the block to the left
  template <bool kUnaligned, std::ptrdiff_t kStage>
  [[gnu::always_inline]] void begin(double* workspace, std::ptrdiff_t block, Block& here) {
    const BlockPlace<double> at = stateOf<kStage>(workspace, block);
    if (kUnaligned) here = load(at);
    const Block next = load(BlockPlace<double>{at.first - kLanes, at.pitch});
    const Block left = kUnaligned ? leftNeighbours(at) : leftNeighbours(next, here);
    const PlaneVector<Pack> separation{here.x - left.x, here.y - left.y};
    const Pack square = squaredLength(separation);
    const BlockPlace<double> to = placeIn(workspace, kSprings, block);
    separation.x.store(to.first);
    separation.y.store(to.first + to.pitch);
    (kInvertsApart ? squareRoot(square) : inverseSquareRoot(square)).store(to.first + 2 * to.pitch);
    if constexpr (kDamped) {
      const PlaneVector<Pack> relative_velocity{here.vx - left.vx, here.vy - left.vy};
      dotProduct(relative_velocity, separation).store(to.first + 3 * to.pitch);
    }
    here = next;
  }

  /// Middle phase.
  [[gnu::always_inline]] static void invert(double* workspace, std::ptrdiff_t block) {
    if (!kInvertsApart) return;
    const BlockPlace<double> springs = placeIn(workspace, kSprings, block);
    double* const length = springs.first + 2 * springs.pitch;
    inverseOrZero(Pack::load(length)).store(length);
  }

  [[gnu::always_inline]] static Springs springsBetween(const Block& left, const Block& here) {
    Springs springs{};
    springs.separation = separationsOf(left, here);
    springs.inverse_length = inverseSquareRoot(squaredLength(springs.separation));
    if constexpr (kDamped)
      springs.dot = dotProduct(relativeVelocitiesOf(left, here), springs.separation);
    return springs;
  }

  /// Last phase: forces, slope, and the state of the next stage or the end of the step.
  /// \tparam kInner whether there is a block to the right
  template <std::ptrdiff_t kStage, bool kInner>
  [[gnu::always_inline]] void finish(double* workspace, std::ptrdiff_t block,
                                     PlaneVector<Pack>& next_forces) {
    const Block from = load(placeIn(workspace, kSprings, block));
    const PlaneVector<Pack> forces =
        forcesFrom<kStage, kInner>({{from.x, from.y}, from.vx, from.vy}, block);
    const Block here = load(stateOf<kStage>(workspace, block));
    const Block slope = slopeOf<kGravity, kInner>(chain_, here, forces, next_forces, block);
    next_forces = forces;
    const BlockPlace<double> place = placeOf(state_, chain_.pitch, block);
    const Block start = load(place);
    Block sum = kStage == 0 ? start : load(placeIn(workspace, kSum, block));
    if constexpr (kTableau.b[kStage] != 0.0) {
      sum = plusWeighted(sum, weights_.after[kStages - 1][kStage], slope);
    }
    if constexpr (kStage + 1 == kStages) {
      store(sum, place);
    } else {
      store(sum, placeIn(workspace, kSum, block));
      Block result =
          plusEarlierSlopes<kStage>(start, workspace, block, std::make_index_sequence<kStage>());
      if constexpr (kTableau.a[kStage + 1][kStage] != 0.0) {
        result = plusWeighted(result, weights_.after[kStage][kStage], slope);
      }
      store(result, placeIn(workspace, kAt, block));
      if constexpr (keepsSlope(kStage)) store(slope, slopePlace(workspace, kStage, block));
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

  template <std::ptrdiff_t kStage, std::size_t... kEarlier>
  [[gnu::always_inline]] Block plusEarlierSlopes(Block result, [[maybe_unused]] double* workspace,
                                                 [[maybe_unused]] std::ptrdiff_t block,
                                                 std::index_sequence<kEarlier...> /*stages*/) {
    ((result = kTableau.a[kStage + 1][kEarlier] == 0.0
                   ? result
                   : plusWeighted(result, weights_.after[kStage][kEarlier],
                                  load(slopePlace(workspace, kEarlier, block)))),
     ...);
    return result;
  }

  /// Columns of the workspace, four for each: springs (separation, length, w·d), state of the next
  /// stage, sum up to there, slopes.
  static constexpr std::ptrdiff_t kSprings = 0, kAt = 4, kSum = 8, kSlopes = 12;
  static constexpr std::ptrdiff_t kColumns = kSlopes + (keepsSlopes() ? 4 * kStages : 0);
  static constexpr std::ptrdiff_t kPitch = tilePitch(kTableau.stages);

  [[gnu::always_inline]] static BlockPlace<double> placeIn(double* workspace, std::ptrdiff_t column,
                                                           std::ptrdiff_t block) {
    return {workspace + column * kPitch + block * kLanes, kPitch};
  }
  [[gnu::always_inline]] static BlockPlace<double> slopePlace(double* workspace,
                                                              std::ptrdiff_t stage,
                                                              std::ptrdiff_t block) {
    return placeIn(workspace, kSlopes + 4 * stage, block);
  }
  template <std::ptrdiff_t kStage>
  [[gnu::always_inline]] BlockPlace<double> stateOf(double* workspace, std::ptrdiff_t block) const {
    return kStage == 0 ? placeOf(state_, chain_.pitch, block) : placeIn(workspace, kAt, block);
  }
  /// The forces of the first springs of the tile to the right.
  [[gnu::always_inline]] double* forcesOf(std::ptrdiff_t stage) const {
    return workspace_ + (12 + 4 * kStages) * kPitch + 2 * kLanes * stage;
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
