// The inner loops of the explicit methods. They are compiled once for every instruction set and
// selected at run time:
//
//     slope of a stage     k = F(z + w_1 k_1 + w_2 k_2 + ...)
//     combination          z + w_1 k_1 + w_2 k_2 + ...
//     compensated sum      z + (d + w_1 k_1 + w_2 k_2 + ...), and its rounding error
//     size of an error     max |w_1 k_1 + w_2 k_2 + ...|
//
// The kernels do the operations of the plain code (computeSlope) in the same order, with the same
// fused multiply-adds, so every instruction set gives the same bits. The interface consists of
// pointers and plain structs, because the layout of Eigen's types depends on the instruction set.
#pragma once

#include <spring_pendulum/integration/butcher_tableau.hpp>
#include <spring_pendulum/model/spring_law.hpp>

#include <cstddef>
#include <string_view>
#include <vector>

namespace spring_pendulum {

/// The tableaus for which kernels for whole steps are compiled. Each stage may use the last slope only.
/// Any other tableau runs stage by stage, more slowly but with the same bits.
inline constexpr const ButcherTableau* kFastTableaus[] = {
    &kEulerTableau,
    &kMidpointTableau,
    &kClassicalRungeKuttaTableau,
};

/// Element of the first moving particle in a column of `StateBuffer`. The first particle precedes it,
/// so aligned vectors contain moving particles only: N - 1 particles and N - 1 springs.
inline constexpr std::ptrdiff_t kFirstMoving = 8;

/// A chain of N particles. States and slopes have the layout of `StateBuffer`: column c of moving
/// particle i is element c * pitch + kFirstMoving + i.
struct KernelChain {
  SpringLaw spring;
  double gravity = 0.0;  ///< m/s²; 0 with a drive
  /// Springless accelerations (x, y) of the particles of a driven chain after the first, m/s²: two
  /// columns, `pitch` apart; else null
  const double* drive = nullptr;
  double anchor[2] = {};  ///< acceleration of the first particle of a driven chain, m/s²
  const double* drag_rates = nullptr;  ///< k_air/m of the moving particles, 1/s; null without air
  /// Of the N - 1 moving particles, 1/kg, between zeros: element -1 is that of the first particle
  const double* inverse_masses = nullptr;
  std::ptrdiff_t size = 0;   ///< N >= 1; the first particle is held
  std::ptrdiff_t pitch = 0;  ///< length of a column, see `StateBuffer::pitchFor`
};

/// The term w k of a sum: weight (step size times a coefficient) and slope (N×4).
struct WeightedSlope {
  double weight;
  const double* slope;
};

/// A sum of weighted slopes. Terms are added in the given order, which determines the rounding.
struct SlopeSum {
  WeightedSlope terms[ButcherTableau::kMaxStages];  ///< the first `count`
  std::ptrdiff_t count = 0;
};
inline constexpr SlopeSum kNoSlopes{};

/// The coefficients of a tableau times the step size h, for each stage i.
struct StepWeights {
  static constexpr std::size_t kMostStages = 4;
  double next[kMostStages] = {};         ///< h a_{i+1,i}, s: the last slope in the next stage
  double sum[kMostStages] = {};          ///< h b_i, s
  double dissipation[kMostStages] = {};  ///< h b_i k_d, kg
};

/// Moving particles of the shortest tile of `StagePipeline`. The longest is nearly twice as long.
constexpr std::ptrdiff_t kTileParticles = 128;

/// Length of a column of the workspace of a tile: the particle before it, the tile, and blocks of the
/// tile to the right.
constexpr std::ptrdiff_t tilePitch(std::size_t stages) {
  return 8 + 2 * kTileParticles + 8 * static_cast<std::ptrdiff_t>(stages);
}

/// Doubles of workspace for whole steps: lengths, states and sums of a tile, then forces.
constexpr std::ptrdiff_t stepWorkspaceSize(std::size_t stages) {
  return 9 * tilePitch(stages) + 2 * 8 * static_cast<std::ptrdiff_t>(stages);
}

/// Terms that a kernel for whole steps computes. A term that is 0 may be left out for speed.
struct StepNeeds {
  bool damping = true;
  bool dissipation = false;  ///< sum the dissipated energy; requires damping
};

/// Takes `steps` steps in place.
/// \param dissipated column to which the energy dissipated by each dashpot is added, J; may be null
///   without `StepNeeds::dissipation`
/// \param workspace `stepWorkspaceSize` doubles, aligned like a column, zero before the first call
using AdvanceKernel = void (*)(const KernelChain& chain, const StepWeights& weights,
                               std::ptrdiff_t steps, double* state, double* dissipated,
                               double* workspace);

/// Largest absolute values in a sum of slopes; NaN if an element is not finite.
struct LargestChange {
  double position;  ///< of the x and y columns
  double velocity;  ///< of the vx and vy columns
};

/// How much springs change within a step. Much is a change along the old direction by at least 0.9
/// of the old length or, if that was 0, to at least 1e-12 m. A change within the rounding errors of the
/// positions is little, however short the spring is. NaN counts as much.
enum class SpringChange {
  kLittle,
  kUnclear,  ///< little until the end of the step, but perhaps much until its middle
  kMuch,     ///< much until the end of the step, at least for one spring
};

/// Largest absolute values of acceleration coefficients K-1, K-2, K-3 and K-4 of a Taylor series of
/// order K; NaN if an element is not finite.
struct LastCoefficients {
  double size[4];
};

inline constexpr std::ptrdiff_t kLargestTaylorOrder = 14;

/// Taylor coefficients of a chain's motion about one state; taylor_stepper.hpp derives the method. Spring i joins particles i and i+1. The
/// columns are padded to `pitch`; the padding holds springs that exert no force.
struct TaylorWorkspace {
  KernelChain chain;
  std::ptrdiff_t order = 0;  ///< K in 2..14, number of force coefficients

  /// Groups of 8 springs, each with `kSpringRows` rows of 4 × 8 doubles. Row n <= 14 holds
  /// coefficient n of the separation (x, y), the length L and the quotient u = T/L. Row 15 holds
  /// the direction d_0/L_0 (x, y) and 1/L_0. Row 16 holds partial sums of the next odd order.
  double* springs = nullptr;
  /// K × 2 columns: coefficient n of the accelerations (x, y).
  double* accelerations = nullptr;

  /// Not 16: groups of 16 rows of 256 bytes would be 4 KiB apart, and loads would wait for stores to
  /// the same row of another group (4K aliasing). The series of 101 particles took 10 % longer.
  static constexpr std::ptrdiff_t kSpringRows = kLargestTaylorOrder + 3;
};

/// Weights of the acceleration coefficients 0..count-1 in the position and velocity sums, and of
/// the initial velocities in the position sum. Weights from `count` on are undefined; otherwise they
/// would be set to 0 in every step.
struct TaylorWeights {
  std::ptrdiff_t count = 0;
  double start_velocity = 0.0;           ///< s
  double position[kLargestTaylorOrder];  ///< s^(n+2)
  double velocity[kLargestTaylorOrder];  ///< s^(n+1)
};

/// The kernels of one instruction set. Outputs must not overlap inputs.
struct ChainKernels {
  std::string_view name;  ///< "baseline", "avx2", "avx512"

  /// slope = F(state + sum), or F(state) for an empty sum. Row 0 is zero unless the chain is driven.
  void (*stageSlope)(const KernelChain& chain, const double* state, const SlopeSum& sum,
                     double* slope);

  /// out = state + sum; `out` may be `state`
  void (*combine)(std::ptrdiff_t pitch, const double* state, const SlopeSum& sum, double* out);

  /// to += weight * from, for `count` numbers, a multiple of 8
  void (*addWeighted)(std::ptrdiff_t count, double weight, const double* from, double* to);

  /// out = state + (change + sum), lost = (change + sum) - (out - state). `lost` is the rounding
  /// error of the addition, exact where |change + sum| <= |state|. The caller passes it as part of
  /// the next `change`. W. Kahan, Comm. ACM 8 (1965) 40, doi:10.1145/363707.363723.
  void (*compensatedSum)(std::ptrdiff_t pitch, const double* state, const double* change,
                         const SlopeSum& sum, double* out, double* lost);

  /// Returns the largest absolute values of a sum over the first `size` particles.
  LargestChange (*largestChange)(std::ptrdiff_t size, std::ptrdiff_t pitch, const SlopeSum& sum);

  /// Returns how much the springs between the first `size` particles change in a step of h s.
  SpringChange (*springChange)(std::ptrdiff_t size, std::ptrdiff_t pitch, double h,
                               const double* from, const double* to);

  /// dissipated += weight * rate² for the N - 1 springs of a chain, with their elongation rates in
  /// `state` and weight = k_d times a time, kg. Later elements of the column are undefined.
  void (*addDissipation)(const KernelChain& chain, const double* state, double weight,
                         double* dissipated);

  /// Returns the kernel for whole steps of `kFastTableaus[tableau]`; see findAdvanceKernel.
  AdvanceKernel (*advanceKernel)(std::size_t tableau, StepNeeds needs);

  /// Computes all Taylor coefficients of the motion about `state`.
  void (*taylorSeries)(const TaylorWorkspace& work, const double* state);

  /// out = base + weighted sum of the series about `state`. `out` may be `state` or `base`.
  void (*taylorState)(const TaylorWorkspace& work, const double* state, const double* base,
                      const TaylorWeights& weights, double* out);

  /// Returns the largest absolute values in a weighted sum of the acceleration coefficients.
  LargestChange (*taylorLargestSum)(const TaylorWorkspace& work, const TaylorWeights& weights);

  /// Returns the sizes of the last acceleration coefficients.
  LastCoefficients (*lastCoefficients)(const TaylorWorkspace& work);
};

/// Every file in the folder `instruction_sets` that is named after an instruction set is compiled for
/// it. None of its code may run on a processor without that instruction set.
extern const ChainKernels kBaselineKernels;
extern const ChainKernels kAvx2Kernels;
extern const ChainKernels kAvx512Kernels;

/// Returns the kernels of every instruction set of this processor, the fastest first. The last is
/// the baseline, which all processors of the architecture have. If the environment variable
/// SPRING_PENDULUM_INSTRUCTION_SET names an instruction set, faster ones are left out.
/// \throws InputError if the variable names no instruction set of this processor
const std::vector<const ChainKernels*>& supportedChainKernels();

/// Returns the named instruction set's kernels and all slower ones of this processor.
/// \throws InputError if this processor has no instruction set of that name
std::vector<const ChainKernels*> chainKernelsUpTo(std::string_view name);

/// Returns the kernel for whole steps of a tableau, which is recognised by its coefficients; null
/// if it is not one of `kFastTableaus`.
AdvanceKernel findAdvanceKernel(const ChainKernels& kernels, const ButcherTableau& tableau,
                                StepNeeds needs = {});

inline const ChainKernels& fastestChainKernels() {
  return *supportedChainKernels().front();
}

}  // namespace spring_pendulum
