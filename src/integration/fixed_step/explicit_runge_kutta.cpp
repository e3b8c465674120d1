#include "integration/fixed_step/explicit_runge_kutta.hpp"

#include "base/checks.hpp"

#include <algorithm>
#include <cassert>
#include <thread>

namespace spring_pendulum {
namespace {

/// Halo results are discarded; this limit keeps halos below a sixteenth of the work.
Eigen::Index largestHalo(Eigen::Index block_size, std::size_t stages) {
  return std::max(StateBuffer::paddedSize(static_cast<Eigen::Index>(stages)),
                  block_size / 32 / 8 * 8);
}

/// Blocks are at least half as long as this size, and a halo is no longer than a block.
Eigen::Index usableBlockSize(Eigen::Index wanted, std::size_t stages) {
  return std::max(StateBuffer::paddedSize(wanted),
                  2 * StateBuffer::paddedSize(static_cast<Eigen::Index>(stages)));
}

Eigen::Index greatestNumberOfShares(int threads, Eigen::Index blocks) {
  if (blocks <= 1) return 1;  // asking for the cores takes as long as 100 steps of a short chain
  const auto available = static_cast<Eigen::Index>(std::thread::hardware_concurrency());
  return std::max<Eigen::Index>(1, std::min(threads > 0 ? threads : available, blocks));
}

}  // namespace

ExplicitRungeKutta::ExplicitRungeKutta(const Chain& chain, const ButcherTableau& tableau,
                                       const IntegratorOptions& options,
                                       const EngineOptions& engine)
    : FixedStepIntegrator(chain, options.track_dissipation && chain.spring().damping != 0.0,
                          engine.kernels != nullptr ? *engine.kernels : fastestChainKernels()),
      engine_(engine),
      stages_(tableau.stages),
      tableau_(tableau),
      kernel_(
          findAdvanceKernel(kernels_, tableau,
                            {chain.spring().damping != 0.0, energy_flow_.ofSprings() != nullptr})) {
  assert(kernel_ != nullptr);
  engine_.block_size = usableBlockSize(engine.block_size, stages_);
  const bool one_block = chain.size() <= engine_.block_size;
  if (!one_block) largest_halo_ = largestHalo(engine_.block_size, stages_);
  const Eigen::Index rows = one_block ? chain.size() : engine_.block_size + 2 * largest_halo_;
  shares_.resize(static_cast<std::size_t>(
      greatestNumberOfShares(options.threads, chain.size() / engine_.block_size)));
  for (Share& share : shares_) {
    share.left.resize(largest_halo_, 4);
    share.right.resize(largest_halo_, 4);
    share.block = StateBuffer(rows);
    if (energy_flow_.ofSprings() != nullptr && !one_block)
      share.dissipated = AlignedNumbers(share.block.pitch());
    share.workspace = AlignedNumbers(stepWorkspaceSize(stages_));
  }
  workers_ = std::make_unique<WorkerThreads>(static_cast<int>(shares_.size()), [this](int share) {
    workOn(shares_[static_cast<std::size_t>(share)]);
  });
}

void ExplicitRungeKutta::integrate(State& state, double time_step, std::int64_t steps) {
  requireAdvance(chain().size, state.size(), time_step, steps);
  if (steps == 0) return;  // kernels take at least one
  held_.begin(state, time_step);
  for (std::size_t i = 0; i < stages_; ++i) {
    weights_.next[i] = i + 1 < stages_ ? time_step * tableau_.a[i + 1][i] : 0.0;
    weights_.sum[i] = time_step * tableau_.b[i];
    weights_.dissipation[i] = time_step * tableau_.b[i] * chain().spring.damping;
  }
  const auto stages = static_cast<std::int64_t>(stages_);
  force_evaluations_ += steps * stages;
  if (largest_halo_ == 0) return stepWhole(state, steps);
  // NOLINTNEXTLINE(clang-analyzer-core.DivideZero): every tableau has at least one stage
  const std::int64_t at_once = largest_halo_ / stages;
  const int threads = threadsFor(std::min(steps, at_once));
  for (; steps > 0; steps -= pass_.steps) {
    pass_.state = &state;
    pass_.steps = std::min(steps, at_once);
    pass_.halo = StateBuffer::paddedSize(pass_.steps * stages);
    divide(threads);
    workers_->run(threads);
  }
}

void ExplicitRungeKutta::stepWhole(State& state, std::int64_t steps) {
  Share& share = shares_.front();
  share.block.values() = state.values();
  kernel_(chain(), weights_, steps, share.block.data(), energy_flow_.ofSprings(),
          share.workspace.data());
  state.values() = share.block.values();
}

int ExplicitRungeKutta::threadsFor(std::int64_t steps) const {
  const double work =
      kFixedStepTime.of(chain().size) * static_cast<double>(stages_) * static_cast<double>(steps);
  return static_cast<int>(
      std::clamp(work / engine_.least_work_per_thread, 1.0, static_cast<double>(workers_->size())));
}

void ExplicitRungeKutta::divide(int threads) {
  const Eigen::Index size = chain().size;
  const Eigen::Index share_size = StateBuffer::paddedSize((size + threads - 1) / threads);
  for (int i = 0; i < threads; ++i) {
    Share& share = shares_[static_cast<std::size_t>(i)];
    share.begin = std::min(size, i * share_size);
    share.end = std::min(size, share.begin + share_size);
    const Eigen::Index left = std::min(pass_.halo, share.begin);
    const Eigen::Index right = std::min(pass_.halo, size - share.end);
    share.left.topRows(left) = pass_.state->values().middleRows(share.begin - left, left);
    share.right.topRows(right) = pass_.state->values().middleRows(share.end, right);
  }
}

void ExplicitRungeKutta::workOn(Share& share) {
  const Eigen::Index size = share.end - share.begin;
  if (size == 0) return;
  const Eigen::Index blocks = (size + engine_.block_size - 1) / engine_.block_size;
  const Eigen::Index block_size = StateBuffer::paddedSize((size + blocks - 1) / blocks);
  for (Eigen::Index begin = share.begin; begin < share.end; begin += block_size)
    stepBlock(share, begin, std::min(share.end, begin + block_size));
}

void ExplicitRungeKutta::stepBlock(Share& share, Eigen::Index begin, Eigen::Index end) {
  auto state = pass_.state->values();
  const Eigen::Index first = std::max<Eigen::Index>(0, begin - pass_.halo);
  const Eigen::Index last = std::min(state.rows(), end + pass_.halo);
  const Eigen::Index own_end = std::min(last, share.end);
  auto block = share.block.values();
  block.topRows(begin - first) = share.left.topRows(begin - first);
  block.middleRows(begin - first, own_end - begin) = state.middleRows(begin, own_end - begin);
  block.middleRows(own_end - first, last - own_end) = share.right.topRows(last - own_end);
  if (end < share.end)
    share.left.topRows(pass_.halo) = state.middleRows(end - pass_.halo, pass_.halo);
  double* const in_block = share.dissipated.data();
  if (in_block != nullptr)
    std::copy_n(energy_flow_.ofSprings() + begin, end - begin, in_block + (begin - first));
  KernelChain piece = chain();
  piece.inverse_masses += first;
  piece.size = last - first;
  piece.pitch = share.block.pitch();
  kernel_(piece, weights_, pass_.steps, share.block.data(), in_block, share.workspace.data());
  if (in_block != nullptr)
    std::copy_n(in_block + (begin - first), end - begin, energy_flow_.ofSprings() + begin);
  const Eigen::Index moving = std::max<Eigen::Index>(1, begin);
  state.middleRows(moving, end - moving) = block.middleRows(moving - first, end - moving);
}

}  // namespace spring_pendulum
