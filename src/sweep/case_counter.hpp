// Hands out the numbers of the cases, to threads and to the ranks of an MPI job.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

namespace spring_pendulum::sweep {

/// Counts for all threads of all ranks together. One process without MPI is rank 0 of one.
class CaseCounter {
 public:
  /// Starts MPI if the program was started as one of several processes. All ranks construct one.
  /// \throws InputError if it was but is built without MPI, MPI does not know the others, or it does
  ///   not support threads
  CaseCounter();
  ~CaseCounter();
  CaseCounter(const CaseCounter&) = delete;
  CaseCounter& operator=(const CaseCounter&) = delete;

  int rank() const { return rank_; }

  /// Returns 0, 1, 2, ...: each number once.
  std::int64_t next();
  /// Serves requests of other ranks where the network does not by itself. Rank 0 calls it often.
  void poll();
  /// Waits for all ranks to call this function. \returns the largest of their values
  int largest(int value);
  /// Ends all ranks with an exit status, if there are several.
  void abort(int status) const;

 private:
  struct Mpi;

  std::unique_ptr<Mpi> mpi_;  ///< null: one process
  int rank_ = 0;
  std::mutex mutex_;  ///< MPI is called by one thread at a time
  std::atomic<std::int64_t> next_{0};
};

}  // namespace spring_pendulum::sweep
