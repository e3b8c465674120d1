// Hands out the numbers of the cases, to threads and to the ranks of an MPI job.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

namespace spring_pendulum::sweep {

/// Counts for all threads of one process, which is rank 0 of one.
class CaseCounter {
 public:
  CaseCounter() = default;
  virtual ~CaseCounter() = default;
  CaseCounter(const CaseCounter&) = delete;
  CaseCounter& operator=(const CaseCounter&) = delete;

  virtual int rank() const { return 0; }
  /// Returns 0, 1, 2, ...: each number once, in all ranks together.
  virtual std::int64_t next() { return next_++; }
  /// Serves requests of other ranks where the network does not by itself. Rank 0 calls it often.
  virtual void poll() {}
  /// Waits for all ranks to call this function. \returns the largest of their values
  virtual int largest(int value) { return value; }
  /// Ends all ranks with an exit status, if there are several. \returns the status
  virtual int abort(int status) const { return status; }

 private:
  std::atomic<std::int64_t> next_{0};
};

/// Returns a counter for all ranks if the program was started as one of several processes; all construct one.
/// \param is_shard whether a process that is alone in MPI, or built without it, has cases of its own
/// \throws InputError if it has none, or MPI supports no threads
std::unique_ptr<CaseCounter> makeCaseCounter(bool is_shard);

}  // namespace spring_pendulum::sweep
