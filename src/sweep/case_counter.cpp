#include "sweep/case_counter.hpp"

#include "base/numbers.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <algorithm>
#include <cstdlib>
#ifdef SPRING_PENDULUM_MPI
#include <mpi.h>
#include <mutex>
#endif

namespace spring_pendulum::sweep {
namespace {

#ifdef SPRING_PENDULUM_MPI
/// The counter lies on rank 0, in a window that all ranks may change.
class MpiCounter : public CaseCounter {
 public:
  MpiCounter() {
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &threads_);
    MPI_Win_allocate(sizeof(std::int64_t), sizeof(std::int64_t), MPI_INFO_NULL, MPI_COMM_WORLD,
                     &counter_, &window_);
    *counter_ = 0;
    MPI_Barrier(MPI_COMM_WORLD);
    MPI_Win_lock_all(0, window_);
  }
  ~MpiCounter() override {
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
    MPI_Finalize();
  }

  bool isAlone() const {
    int size = 0;
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    if (size > 1 && threads_ < MPI_THREAD_SERIALIZED)
      throw InputError("this MPI does not support threads (MPI_THREAD_SERIALIZED); use --shard");
    return size == 1;
  }
  int rank() const override {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank;
  }
  std::int64_t next() override {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::int64_t one = 1;
    std::int64_t number = 0;
    MPI_Fetch_and_op(&one, &number, MPI_INT64_T, 0, 0, MPI_SUM, window_);
    MPI_Win_flush(0, window_);
    return number;
  }
  void poll() override {
    const std::lock_guard<std::mutex> lock(mutex_);
    int arrived = 0;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &arrived, MPI_STATUS_IGNORE);
  }
  int largest(int value) override {
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    return value;
  }
  int abort(int status) const override { return MPI_Abort(MPI_COMM_WORLD, status); }

 private:
  int threads_ = 0;
  std::int64_t* counter_ = nullptr;
  MPI_Win window_ = MPI_WIN_NULL;
  std::mutex mutex_;  ///< MPI is called by one thread at a time
};
#endif

/// Whether mpirun or srun has started several processes. Without MPI, each would run all cases.
bool isOneOfSeveral() {
  const auto counts = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"};
  return std::any_of(counts.begin(), counts.end(), [](const char* name) {
    const char* const text = std::getenv(name);
    return text != nullptr && parseInteger(text).value_or(1) > 1;
  });
}

}  // namespace

std::unique_ptr<CaseCounter> makeCaseCounter(bool is_shard) {
  const auto is_set = [](const char* name) { return std::getenv(name) != nullptr; };
  // Where no launcher of MPI has started a shard, MPI would start a server, which may outlive it.
  if (!isOneOfSeveral() || (is_shard && !is_set("PMIX_RANK") && !is_set("PMI_RANK")))
    return std::make_unique<CaseCounter>();  // starting MPI takes 0.3 s
#ifdef SPRING_PENDULUM_MPI
  auto counter = std::make_unique<MpiCounter>();
  if (!counter->isAlone()) return counter;
#endif
  if (is_shard) return std::make_unique<CaseCounter>();
  throw InputError(
      "several processes, each alone: use --shard, or a build with MPI and srun --mpi=pmix");
}

}  // namespace spring_pendulum::sweep
