#include "sweep/running/dispatcher.hpp"

#include "io/program/command_line.hpp"

#ifdef SPRING_PENDULUM_MPI
#include <spring_pendulum/base/errors.hpp>

#include <array>
#include <chrono>
#include <thread>

#include "mpi/ranks.hpp"

namespace spring_pendulum::sweep {
namespace {

constexpr int kRequest = 1;
constexpr int kAnswer = 2;
/// MPI waits with a core of its own, so rank 0 looks for requests this often. A batch takes 50 ms.
constexpr std::chrono::microseconds kPause{200};

using Message = std::array<std::int64_t, 2>;

void sendRequest(std::int64_t finished, bool leaves) {
  const Message message{finished, leaves ? 1 : 0};
  MPI_Send(message.data(), 2, MPI_INT64_T, 0, kRequest, MPI_COMM_WORLD);
}

}  // namespace

Dispatcher::Dispatcher() {
  if (startedRanks().count == 1) return;  // starting MPI takes 0.3 s
  ranks_ = std::make_unique<Ranks>();
  int threads = 0;
  MPI_Query_thread(&threads);
  if (threads < MPI_THREAD_SERIALIZED) {
    throw InputError("this MPI does not support threads (MPI_THREAD_SERIALIZED); use --shard");
  }
  rank_ = ranks_->rank();
  size_ = ranks_->size();
  on_this_machine_ = ranks_->onThisMachine();
}

Dispatcher::~Dispatcher() = default;

void Dispatcher::meet() const {
  if (ranks_) MPI_Barrier(MPI_COMM_WORLD);
}

void Dispatcher::serve(const std::function<std::int64_t()>& next,
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

std::int64_t Dispatcher::ask(std::int64_t finished) {
  const std::lock_guard<std::mutex> lock(mutex_);
  sendRequest(finished, false);
  std::int64_t batch = -1;
  MPI_Recv(&batch, 1, MPI_INT64_T, 0, kAnswer, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return batch;
}

void Dispatcher::leave(std::int64_t finished) {
  const std::lock_guard<std::mutex> lock(mutex_);
  sendRequest(finished, true);
}

void Dispatcher::abort(int status) const {
  if (size_ > 1) abortAllRanks(status);
}

}  // namespace spring_pendulum::sweep

#else

namespace spring_pendulum {
class Ranks {};
}  // namespace spring_pendulum

namespace spring_pendulum::sweep {

Dispatcher::Dispatcher() {
  refuseSeveralRanks("build sweep with MPI, or use --shard");
}

Dispatcher::~Dispatcher() = default;
void Dispatcher::meet() const {}
void Dispatcher::serve(const std::function<std::int64_t()>&,
                       const std::function<void(std::int64_t)>&) const {}
std::int64_t Dispatcher::ask(std::int64_t) {
  return -1;
}
void Dispatcher::leave(std::int64_t) {}
void Dispatcher::abort(int) const {}

}  // namespace spring_pendulum::sweep

#endif
