// A pool of threads, so that a call need not start threads.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <sys/types.h>
#include <thread>
#include <vector>

namespace spring_pendulum {

/// Runs `task(0) ... task(n - 1)` in parallel, any number of times. A process that was forked has none
/// of the threads of its parent and starts its own.
class WorkerThreads {
 public:
  /// \param threads number of threads including the calling one; fewer if the system refuses some
  /// \param task    must not throw
  WorkerThreads(int threads, std::function<void(int)> task);
  ~WorkerThreads();
  WorkerThreads(const WorkerThreads&) = delete;
  WorkerThreads& operator=(const WorkerThreads&) = delete;

  /// Number of threads, including the calling one.
  int size() const { return static_cast<int>(pool_->threads.size()) + 1; }

  /// Runs the tasks 0 <= i < count and waits for all of them. The calling thread runs task 0 and those
  /// for which there is no thread.
  void run(int count);

 private:
  struct Pool {
    std::mutex mutex;
    std::condition_variable begin;
    std::condition_variable done;
    std::int64_t run = 0;  ///< number of calls of `run`
    int count = 0;         ///< number of tasks of the current run
    int unfinished = 0;    ///< unfinished tasks of the other threads
    bool stop = false;
    std::vector<std::thread> threads;
  };

  void start(int threads);
  void work(Pool& pool, int index);

  std::function<void(int)> task_;
  pid_t process_ = 0;  ///< in which the threads were started
  std::unique_ptr<Pool> pool_;
};

}  // namespace spring_pendulum
