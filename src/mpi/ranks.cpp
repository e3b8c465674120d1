#include "mpi/ranks.hpp"

#include "io/program/exit_status.hpp"
#include "io/program/standard_streams.hpp"

#include <cstdlib>
#include <exception>
#include <numeric>

namespace spring_pendulum {

Ranks::Ranks() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  MPI_Comm_size(machine, &on_this_machine_);
  MPI_Comm_free(&machine);
}

Ranks::~Ranks() {
  MPI_Finalize();
}

void Ranks::together(const std::function<void()>& action) const {
  Failure failure{"", kDone};
  try {
    action();
  } catch (const std::exception& error) {
    failure = failureOf(error);
  }
  const int mine = failure.status == kDone ? size_ : rank_;
  int lowest = size_;
  MPI_Allreduce(&mine, &lowest, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (lowest == size_) return;
  if (lowest == rank_) printError(failure.message + "\n");
  int status = failure.status;
  MPI_Bcast(&status, 1, MPI_INT, lowest, MPI_COMM_WORLD);
  throw RankFailure{status};
}

std::string Ranks::shareFromFirst(std::string text) const {
  std::size_t length = text.size();
  shareFromFirst(&length, 1);
  text.resize(length);
  shareFromFirst(text.data(), static_cast<int>(length));
  return text;
}

std::vector<std::int64_t> Ranks::largest(std::vector<std::int64_t> values) const {
  if (size_ == 1) return values;
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_INT64_T, MPI_MAX,
                MPI_COMM_WORLD);
  return values;
}

std::int64_t Ranks::sumBefore(std::int64_t value, std::int64_t& total) const {
  std::int64_t before = 0;
  MPI_Exscan(&value, &before, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  MPI_Allreduce(&value, &total, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  return isFirst() ? 0 : before;
}

std::vector<double> Ranks::gather(const std::vector<double>& numbers) const {
  const int count = static_cast<int>(numbers.size());
  std::vector<int> counts(static_cast<std::size_t>(size_));
  MPI_Gather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
  std::vector<int> places(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), places.begin(), 0);
  std::vector<double> all(isFirst() ? static_cast<std::size_t>(places.back() + counts.back()) : 0);
  MPI_Gatherv(numbers.data(), count, MPI_DOUBLE, all.data(), counts.data(), places.data(),
              MPI_DOUBLE, 0, MPI_COMM_WORLD);
  return all;
}

void abortAllRanks(int status) {
  MPI_Abort(MPI_COMM_WORLD, status);
  std::_Exit(status);
}

}  // namespace spring_pendulum
