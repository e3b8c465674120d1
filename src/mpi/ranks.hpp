// The processes of an MPI job, called ranks.
#pragma once

#include <cstdint>
#include <functional>
#include <mpi.h>
#include <string>
#include <vector>

namespace spring_pendulum {

/// Thrown on all ranks after one of them has failed and printed why.
struct RankFailure {
  int status;  ///< exit status of the program
};

/// All ranks of the job. Functions that say "all ranks" must be called by all of them.
class Ranks {
 public:
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  bool isFirst() const { return rank_ == 0; }
  bool isLast() const { return rank_ + 1 == size_; }
  /// Number of ranks on this machine.
  int onThisMachine() const { return on_this_machine_; }

  /// Runs an action without communication on all ranks. If it throws, the lowest of these ranks prints
  /// the error. \throws RankFailure on all ranks if it throws on one
  void together(const std::function<void()>& action) const;

  /// Returns values of the first rank to all ranks.
  template <typename Number>
  void shareFromFirst(Number* values, int count) const {
    MPI_Bcast(values, count * static_cast<int>(sizeof(Number)), MPI_BYTE, 0, MPI_COMM_WORLD);
  }
  std::string shareFromFirst(std::string text) const;

  /// Returns the largest value of all ranks, element by element.
  std::vector<std::int64_t> largest(std::vector<std::int64_t> values) const;
  /// Returns the sum of the values of all lower ranks, and sets `total` to that of all ranks.
  std::int64_t sumBefore(std::int64_t value, std::int64_t& total) const;
  /// Returns the numbers of all ranks in their order to the first rank; nothing to the others.
  std::vector<double> gather(const std::vector<double>& numbers) const;

 private:
  int rank_ = 0;
  int size_ = 1;
  int on_this_machine_ = 1;
};

/// Ends the job on all ranks, for an error on this one that the others can't know of.
[[noreturn]] void abortAllRanks(int status);

}  // namespace spring_pendulum
