// A pool of threads, so that a call need not start threads.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace spring_pendulum {

/// Runs `task(0) ... task(n - 1)` in parallel, any number of times.
class WorkerThreads {
 public:
  /// \param threads number of threads including the calling one; fewer if the system refuses some
  /// \param task    must not throw
  WorkerThreads(int threads, std::function<void(int)> task);
  ~WorkerThreads();
  WorkerThreads(const WorkerThreads&) = delete;
  WorkerThreads& operator=(const WorkerThreads&) = delete;

  /// Number of threads, including the calling one.
  int size() const { return static_cast<int>(threads_.size()) + 1; }

  /// Runs the tasks 0 <= i < count, with count <= size(), and waits for all of them. The calling
  /// thread runs task 0.
  void run(int count);

 private:
  void work(int index);

  std::function<void(int)> task_;
  std::mutex mutex_;
  std::condition_variable begin_;
  std::condition_variable done_;
  std::int64_t run_ = 0;  ///< number of calls of `run`
  int count_ = 0;         ///< number of tasks of the current run
  int unfinished_ = 0;    ///< unfinished tasks of the other threads
  bool stop_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace spring_pendulum
