// The inner loops of the explicit methods, on raw numbers, compiled once for every instruction set
// and picked when the program runs:
//
//     slope of a stage     k = F(z + w_1 k_1 + w_2 k_2 + ...)
//     combination          z + w_1 k_1 + w_2 k_2 + ...
//     compensated sum      z + (d + w_1 k_1 + w_2 k_2 + ...), and what of it was rounded away
//     size of an error     max |w_1 k_1 + w_2 k_2 + ...|
//
// Every particle sees the operations of the plain code (computeSlope) in its order, with the
// same fused multiply-adds, so the bits are the same for every instruction set. Eigen's types
// change their layout with the instruction set; nothing but pointers and numbers crosses this
// border.
#pragma once

#include "integration/kernels/taylor_workspace.hpp"
#include <spring_pendulum/integration/butcher_tableau.hpp>
#include <spring_pendulum/model/spring_law.hpp>

#include <cstddef>
#include <string_view>
#include <vector>

namespace spring_pendulum {

/// A chain of N particles as the kernels read it. Column c of a state or a slope of particle i is
/// number c * pitch + i, aligned and padded as `StateBuffer` does it.
struct KernelChain {
  SpringLaw spring;
  double gravity = 0.0;  ///< m/s²
  /// 1/kg, aligned as a column; if `mass_stride` is 0 only eight equal numbers, for all particles
  const double* inverse_masses = nullptr;
  std::ptrdiff_t mass_stride = 1;
  std::ptrdiff_t size = 0;   ///< N >= 1; the first particle is fixed
  std::ptrdiff_t pitch = 0;  ///< distance of two columns, a multiple of 8 and at least N
};

/// w k: a weight (the step times a coefficient of the tableau) and the N×4 slope it weighs.
struct WeightedSlope {
  double weight;
  const double* slope;
};

/// Terms are added in their order, which is part of the arithmetic.
struct SlopeSum {
  const WeightedSlope* terms = nullptr;
  std::ptrdiff_t count = 0;
};

/// The coefficients of a tableau with the step multiplied in: `after[i][j]` is the weight of slope
/// j in the state that follows stage i, of stage i+1 or of the next step.
struct StepWeights {
  double after[ButcherTableau::kMaxStages][ButcherTableau::kMaxStages] = {};
  double heat[ButcherTableau::kMaxStages] = {};  ///< h b_i k_d, kg
};

/// How many blocks at most are under way between the first and the last stage while whole steps are
/// taken along the chain, rounded up to a power of two.
constexpr std::ptrdiff_t ringBlocks(std::size_t stages) {
  std::ptrdiff_t blocks = 8;
  while (blocks < 3 * static_cast<std::ptrdiff_t>(stages)) blocks *= 2;
  return blocks;
}

/// How many doubles of workspace whole steps need: states, sums, slopes and springs of the stages.
constexpr std::ptrdiff_t stepWorkspaceSize(std::size_t stages) {
  return static_cast<std::ptrdiff_t>(stages) * (4 * ringBlocks(stages) * 4 + 2) * 8;
}

/// What a kernel for whole steps does; damping or gravity of 0 need not be computed.
struct StepNeeds {
  bool damping = true;
  bool gravity = true;
  bool heat = false;  ///< of the dashpots; none without damping
};

/// Takes `steps` steps, in place.
/// \param heat a column: what each dashpot dissipates is added, J; may be null if not needed
/// \param workspace `stepWorkspaceSize` doubles, aligned as a column, that were zero once
using AdvanceKernel = void (*)(const KernelChain& chain, const StepWeights& weights,
                               std::ptrdiff_t steps, double* state, double* heat,
                               double* workspace);

/// Largest absolute values in a combination of slopes; NaN if it is not finite.
struct LargestChange {
  double position;  ///< of the x and y columns
  double velocity;  ///< of the vx and vy columns
};

/// The kernels of one instruction set. Outputs must not overlap inputs.
struct ChainKernels {
  std::string_view name;  ///< "baseline", "avx2", "avx512"

  /// slope = F(state + sum); with no terms F(state). Row 0 is zero: the first particle is fixed.
  void (*stageSlope)(const KernelChain& chain, const double* state, SlopeSum sum, double* slope);

  /// out = state + sum; `out` may be `state`
  void (*combine)(std::ptrdiff_t pitch, const double* state, SlopeSum sum, double* out);

  /// to += weight * from, `count` numbers, a multiple of 8.
  void (*addWeighted)(std::ptrdiff_t count, double weight, const double* from, double* to);

  /// out = state + (change + sum), lost = (change + sum) - (out - state): what rounding took from
  /// the sum, exactly where |change + sum| <= |state|. As a part of the next change it is not lost.
  /// W. Kahan, Comm. ACM 8 (1965) 40, doi:10.1145/363707.363723.
  void (*compensatedSum)(std::ptrdiff_t pitch, const double* state, const double* change,
                         SlopeSum sum, double* out, double* lost);

  /// Of the sum alone, over the first `size` particles. A maximum, so no order matters.
  LargestChange (*largestChange)(std::ptrdiff_t size, std::ptrdiff_t pitch, SlopeSum sum);

  /// Whether any spring of the first `size` particles changes, from one state to another, along its
  /// old direction by 0.9 of its old length or more, or to 1e-12 m or more if it had no length. Yes
  /// if anything is not a number.
  bool (*springsChangeMuch)(std::ptrdiff_t size, std::ptrdiff_t pitch, const double* from,
                            const double* to);

  /// Adds to each spring's heat, J, that of its dashpot in a state: weight * rate². Of N - 1
  /// springs; what comes behind them is without meaning.
  void (*addHeat)(const KernelChain& chain, const double* state, double weight, double* heat);

  /// Whole steps of `kFastTableaus[tableau]`; see findAdvanceKernel.
  AdvanceKernel (*advanceKernel)(std::size_t tableau, StepNeeds needs);

  /// All Taylor coefficients of the motion about a state.
  void (*taylorSeries)(const TaylorWorkspace& work, const double* state);

  /// out = base + the weighted sum of the series about `state`; `out` may be either.
  void (*taylorState)(const TaylorWorkspace& work, const double* state, const double* base,
                      const TaylorWeights& weights, double* out);

  /// Largest absolute values in a weighted sum of the accelerations' coefficients.
  LargestChange (*taylorLargestSum)(const TaylorWorkspace& work, const TaylorWeights& weights);

  /// Largest absolute value of coefficient n of the accelerations; NaN if one is not finite.
  double (*taylorLargest)(const TaylorWorkspace& work, std::ptrdiff_t n);
};

/// The kernels of every instruction set that this processor has, the fastest first. The last is the
/// baseline, which all processors of the architecture have. The environment variable
/// SPRING_PENDULUM_INSTRUCTION_SET, if set to the name of one, leaves out all faster ones.
/// \throws InputError if it names none of them
const std::vector<const ChainKernels*>& supportedChainKernels();

/// Those of the processor that are not faster than the named one.
/// \throws InputError if there is no such one, or not on this processor
std::vector<const ChainKernels*> chainKernelsUpTo(std::string_view name);

/// Whole steps of the tableau, known by its coefficients; null if it is none of `kFastTableaus`.
AdvanceKernel findAdvanceKernel(const ChainKernels& kernels, const ButcherTableau& tableau,
                                StepNeeds needs);

/// The fastest of them for a long chain, and for one of so many particles.
const ChainKernels& fastestChainKernels();
const ChainKernels& fastestChainKernels(std::ptrdiff_t particles);

}  // namespace spring_pendulum
