// The engine that runs the explicit Runge-Kutta tableaus with a fixed step, fast.
//
// A long chain is cut into blocks that stay in the second-level cache while they are taken through
// all steps of a call. Information travels one particle a stage, so S steps of s stages need a
// border of S·s particles on both sides of a block: the border is computed along, goes wrong from
// its outer end inwards, and is thrown away. Blocks are shared out to threads. Every particle sees
// the same arithmetic in the same order whatever the blocks, threads, instruction set and skips, so
// the bits are always those of `PlainRungeKutta`.
#pragma once

#include "integration/kernels/dashpot_heat.hpp"
#include "integration/fixed_step/plain_runge_kutta.hpp"
#include "integration/fixed_step/worker_threads.hpp"
#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/kernel_constants.hpp"
#include "integration/kernels/state_buffer.hpp"
#include <spring_pendulum/integration/butcher_tableau.hpp>
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <memory>
#include <vector>

namespace spring_pendulum {

/// How the engine goes about it. Nothing here changes a bit of the result.
struct EngineOptions {
  int threads = 0;  ///< at most; 0: as many as the processor runs at once
  /// Particles in a block: with its workspace it should fit the second-level cache.
  Eigen::Index block_size = 4096;
  /// Another thread is given work only if it gets at least so many spring forces a call: below, to
  /// wake it up takes longer than it helps.
  Eigen::Index least_work_per_thread = 50000;
  const ChainKernels* kernels = nullptr;  ///< null: the fastest ones
  /// What the scene does not need is not done.
  bool skip_damping = true;
  bool skip_gravity = true;
  bool skip_masses = true;
  bool track_dissipation = false;  ///< integrate the dissipated power along
};

/// As `Integrator`. The velocity of the first particle, which is fixed, is set to 0.
class ExplicitRungeKutta : public Integrator {
 public:
  /// \param tableau any; without kernels of its own (fast_tableaus.hpp) it is run by `PlainRungeKutta`
  ExplicitRungeKutta(const Chain& chain, const ButcherTableau& tableau,
                     const EngineOptions& options = {});

  void advance(State& state, double time_step, std::int64_t steps) override;
  std::int64_t forceEvaluations() const override { return force_evaluations_; }
  double dissipatedEnergy() const override;
  void restart() override;
  Skips skips() const override;

 private:
  /// What a thread works with. It does the particles begin <= i < end.
  struct Share {
    Eigen::Index begin = 0;
    Eigen::Index end = 0;
    /// The rows before the next block and those behind the share, as they were before the pass.
    State::Matrix left, right;
    StateBuffer block;
    AlignedNumbers heat;  ///< of the springs of the block
    AlignedNumbers workspace;
  };

  /// The steps of one call that all blocks are taken through before the next are begun.
  struct Pass {
    State* state = nullptr;
    std::int64_t steps = 0;
    Eigen::Index border = 0;
  };

  int threadsFor(std::int64_t steps) const;
  void divide(int threads);
  void workOn(Share& share);
  void stepBlock(Share& share, Eigen::Index begin, Eigen::Index end);

  EngineOptions options_;
  KernelConstants constants_;
  std::size_t stages_;
  bool tracks_heat_;
  const ButcherTableau& tableau_;
  AdvanceKernel kernel_;
  std::unique_ptr<PlainRungeKutta> plain_;  ///< if there is no kernel
  DashpotHeat heat_;
  Eigen::Index largest_border_ = 0;  ///< 0: the whole chain is one block
  StepWeights weights_;
  Pass pass_;
  std::vector<Share> shares_;
  std::unique_ptr<WorkerThreads> workers_;
  std::int64_t force_evaluations_ = 0;
};

}  // namespace spring_pendulum
