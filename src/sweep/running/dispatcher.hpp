// Shares the batches of a sweep among the ranks of an MPI job.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>

namespace spring_pendulum {
class Ranks;
}

namespace spring_pendulum::sweep {

/// Rank 0 hands out batches; the other ranks ask for them. One process without MPI is rank 0 of one.
class Dispatcher {
 public:
  /// Starts MPI if the program was started as one of several ranks.
  /// \throws InputError if it was but is built without MPI
  Dispatcher();
  ~Dispatcher();
  Dispatcher(const Dispatcher&) = delete;
  Dispatcher& operator=(const Dispatcher&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  int ranksOnThisMachine() const { return on_this_machine_; }

  /// Waits for all ranks to call this function.
  void meet() const;

  /// On rank 0: answers requests until every other rank has left.
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
  std::unique_ptr<Ranks> ranks_;  ///< null: one process
  int rank_ = 0;
  int size_ = 1;
  int on_this_machine_ = 1;
  std::mutex mutex_;
};

}  // namespace spring_pendulum::sweep
