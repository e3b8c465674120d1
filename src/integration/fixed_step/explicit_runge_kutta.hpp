// The fast engine for explicit Runge-Kutta tableaus with a fixed step.
//
// A long chain is divided into blocks that stay in the second-level cache through all steps of a
// call (overlapped temporal blocking). Information travels one particle per stage, so S steps of s
// stages need a halo of S·s particles on both sides of a block. The halo is integrated together with
// the block; its errors spread inwards from its outer end, and its results are discarded. Threads
// share the blocks. Every particle sees the same arithmetic in the same order for all block sizes,
// numbers of threads and instruction sets, so the results are always the bits of `PlainRungeKutta`.
//
// Reference: S. Krishnamoorthy and others, PLDI 2007, 235-244, doi:10.1145/1250734.1250761
// (overlapped tiles).
#pragma once

#include "integration/fixed_step/fixed_step_integrator.hpp"
#include "integration/fixed_step/worker_threads.hpp"
#include <spring_pendulum/integration/butcher_tableau.hpp>

#include <memory>
#include <vector>

namespace spring_pendulum {

/// Performance settings, on which no result depends.
struct EngineOptions {
  /// Scene per block. A block and its workspace should fit into the second-level cache.
  Eigen::Index block_size = 4096;
  /// Least work per call and thread, s, see `work`. Waking a thread takes longer than less work.
  double least_work_per_thread = 1e-4;
  const ChainKernels* kernels = nullptr;  ///< null: the fastest kernels that the processor supports
};

class ExplicitRungeKutta final : public FixedStepIntegrator {
 public:
  /// \param tableau one that has a kernel (`findAdvanceKernel`)
  ExplicitRungeKutta(const Chain& chain, const ButcherTableau& tableau,
                     const IntegratorOptions& options, const EngineOptions& engine = {});

 private:
  void integrate(State& state, double time_step, std::int64_t steps) override;
  /// Workspace of a thread that integrates the particles begin <= i < end.
  struct Share {
    Eigen::Index begin = 0;
    Eigen::Index end = 0;
    /// State before the pass: rows to the left of the next block, and to the right of the share.
    State::Matrix left, right;
    StateBuffer block;
    AlignedNumbers dissipated;  ///< energy of each spring of the block, J
    AlignedNumbers workspace;
  };

  /// Steps that every block takes before any block takes the next ones.
  struct Pass {
    State* state = nullptr;
    std::int64_t steps = 0;
    Eigen::Index halo = 0;
  };

  /// Takes the steps of a chain that is one block.
  void stepWhole(State& state, std::int64_t steps);
  int threadsFor(std::int64_t steps) const;
  void divide(int threads);
  void workOn(Share& share);
  void stepBlock(Share& share, Eigen::Index begin, Eigen::Index end);

  EngineOptions engine_;
  std::size_t stages_;
  const ButcherTableau& tableau_;
  AdvanceKernel kernel_;
  Eigen::Index largest_halo_ = 0;  ///< 0: the whole chain is one block
  StepWeights weights_;
  Pass pass_;
  std::vector<Share> shares_;
  std::unique_ptr<WorkerThreads> workers_;
};

}  // namespace spring_pendulum
