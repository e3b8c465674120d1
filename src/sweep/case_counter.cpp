#include "sweep/case_counter.hpp"

#include "base/numbers.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <cstdlib>
#ifdef SPRING_PENDULUM_MPI
#include <mpi.h>
#endif

namespace spring_pendulum::sweep {
namespace {

/// Whether mpirun or srun has started several processes. Without MPI, each would run all cases.
bool isOneOfSeveral() {
  for (const char* const name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"}) {
    const char* const text = std::getenv(name);
    if (text != nullptr && parseInteger(text).value_or(1) > 1) return true;
  }
  return false;
}

}  // namespace

#ifdef SPRING_PENDULUM_MPI

/// The counter lies on rank 0, in a window that all ranks may change.
struct CaseCounter::Mpi {
  Mpi() {
    int threads = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &threads);
    if (threads < MPI_THREAD_SERIALIZED) {
      throw InputError("this MPI does not support threads (MPI_THREAD_SERIALIZED); use --shard");
    }
    MPI_Win_allocate(sizeof(std::int64_t), sizeof(std::int64_t), MPI_INFO_NULL, MPI_COMM_WORLD,
                     &counter, &window);
    *counter = 0;
    MPI_Barrier(MPI_COMM_WORLD);
    MPI_Win_lock_all(0, window);
  }
  ~Mpi() {
    MPI_Win_unlock_all(window);
    MPI_Win_free(&window);
    MPI_Finalize();
  }
  Mpi(const Mpi&) = delete;
  Mpi& operator=(const Mpi&) = delete;

  std::int64_t* counter = nullptr;
  MPI_Win window = MPI_WIN_NULL;
};

CaseCounter::CaseCounter() {
  if (!isOneOfSeveral()) return;  // starting MPI takes 0.3 s
  mpi_ = std::make_unique<Mpi>();
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  if (size > 1) return;
  throw InputError(
      "several processes, but each is alone in MPI: use mpirun, srun --mpi=pmix or --shard");
}

std::int64_t CaseCounter::next() {
  if (!mpi_) return next_++;
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::int64_t one = 1;
  std::int64_t number = 0;
  MPI_Fetch_and_op(&one, &number, MPI_INT64_T, 0, 0, MPI_SUM, mpi_->window);
  MPI_Win_flush(0, mpi_->window);
  return number;
}

void CaseCounter::poll() {
  if (!mpi_) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  int arrived = 0;
  MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &arrived, MPI_STATUS_IGNORE);
}

int CaseCounter::largest(int value) {
  if (mpi_) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  return value;
}

void CaseCounter::abort(int status) const {
  if (mpi_) MPI_Abort(MPI_COMM_WORLD, status);
}

#else

struct CaseCounter::Mpi {};

CaseCounter::CaseCounter() {
  if (isOneOfSeveral()) throw InputError("several processes: build sweep with MPI, or use --shard");
}
std::int64_t CaseCounter::next() {
  return next_++;
}
void CaseCounter::poll() {}
int CaseCounter::largest(int value) {
  return value;
}
void CaseCounter::abort(int) const {}

#endif

CaseCounter::~CaseCounter() = default;

}  // namespace spring_pendulum::sweep
