#include "sweep/running/ranks.hpp"

#include "io/program/command_line.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <array>
#include <chrono>
#include <thread>

#ifdef SPRING_PENDULUM_MPI
#include <mpi.h>
#endif

namespace spring_pendulum::sweep {
namespace {

#ifdef SPRING_PENDULUM_MPI

constexpr int kRequest = 1;
constexpr int kAnswer = 2;
/// MPI waits with a core of its own, so rank 0 looks for requests this often. A batch takes 50 ms.
constexpr std::chrono::microseconds kPause{200};

using Message = std::array<std::int64_t, 2>;

void sendRequest(std::int64_t finished, bool leaves) {
  const Message message{finished, leaves ? 1 : 0};
  MPI_Send(message.data(), 2, MPI_INT64_T, 0, kRequest, MPI_COMM_WORLD);
}

#endif

}  // namespace

#ifdef SPRING_PENDULUM_MPI

Ranks::Ranks() {
  if (startedRanks().count == 1) return;
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  if (provided < MPI_THREAD_SERIALIZED) {
    throw InputError("this MPI does not support threads (MPI_THREAD_SERIALIZED); use --shard");
  }
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  MPI_Comm machine{};
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &machine);
  MPI_Comm_size(machine, &neighbours_);
  MPI_Comm_free(&machine);
}

Ranks::~Ranks() {
  if (size_ > 1) MPI_Finalize();
}

void Ranks::meet() const {
  if (size_ > 1) MPI_Barrier(MPI_COMM_WORLD);
}

void Ranks::serve(const std::function<std::int64_t()>& next,
                  const std::function<void(std::int64_t)>& note) const {
  for (int working = size_ - 1; working > 0;) {
    int arrived = 0;
    MPI_Status status{};
    MPI_Iprobe(MPI_ANY_SOURCE, kRequest, MPI_COMM_WORLD, &arrived, &status);
    if (arrived == 0) {
      note(0);
      std::this_thread::sleep_for(kPause);
      continue;
    }
    Message message{};
    MPI_Recv(message.data(), 2, MPI_INT64_T, status.MPI_SOURCE, kRequest, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    note(message[0]);
    if (message[1] != 0) {
      --working;
      continue;
    }
    const std::int64_t batch = next();
    MPI_Send(&batch, 1, MPI_INT64_T, status.MPI_SOURCE, kAnswer, MPI_COMM_WORLD);
  }
}

std::int64_t Ranks::ask(std::int64_t finished) {
  const std::lock_guard<std::mutex> lock(mutex_);
  sendRequest(finished, false);
  std::int64_t batch = -1;
  MPI_Recv(&batch, 1, MPI_INT64_T, 0, kAnswer, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return batch;
}

void Ranks::leave(std::int64_t finished) {
  const std::lock_guard<std::mutex> lock(mutex_);
  sendRequest(finished, true);
}

void Ranks::abort(int status) const {
  if (size_ > 1) MPI_Abort(MPI_COMM_WORLD, status);
}

#else

Ranks::Ranks() {
  refuseSeveralRanks("build sweep with MPI, or use --shard");
}

Ranks::~Ranks() = default;
void Ranks::meet() const {}
void Ranks::serve(const std::function<std::int64_t()>&,
                  const std::function<void(std::int64_t)>&) const {}
std::int64_t Ranks::ask(std::int64_t) {
  return -1;
}
void Ranks::leave(std::int64_t) {}
void Ranks::abort(int) const {}

#endif

}  // namespace spring_pendulum::sweep
