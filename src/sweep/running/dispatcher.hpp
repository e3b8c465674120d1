// The processes of one sweep: the ranks of an MPI job, or one process.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>

namespace spring_pendulum::sweep {

/// Rank 0 hands out batches; the other ranks ask for them. Only the C interface of MPI, and only
/// messages between two ranks.
class Ranks {
 public:
  /// Starts MPI if the program was started as one of several ranks.
  /// \throws InputError if it was but is built without MPI
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  /// Number of ranks on this machine.
  int neighbours() const { return neighbours_; }

  /// Waits for all ranks to call this function.
  void meet() const;

  /// On rank 0: answers requests until every other rank has finished.
  /// \param next returns the number of the next batch; negative: none
  /// \param note gets the number of cases that another rank has finished since its last request
  void serve(const std::function<std::int64_t()>& next,
             const std::function<void(std::int64_t)>& note) const;
  /// On another rank: returns the number of the next batch; negative: none. Threads may call it.
  /// \param finished number of cases since the last call
  std::int64_t ask(std::int64_t finished);
  /// On another rank: tells rank 0 that it has finished.
  void leave(std::int64_t finished);

  /// Ends all ranks with an exit status, if there are several.
  void abort(int status) const;

 private:
  int rank_ = 0;
  int size_ = 1;
  int neighbours_ = 1;
  std::mutex mutex_;
};

}  // namespace spring_pendulum::sweep
