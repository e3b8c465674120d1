// Threads that wait for work, so that none has to be started in every call.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace spring_pendulum {

/// Does `task(0) ... task(n - 1)` side by side, again and again.
class WorkerThreads {
 public:
  /// \param threads how many threads work, the calling one included; fewer if the system has none
  /// to
  ///                give
  /// \param task must not throw
  WorkerThreads(int threads, std::function<void(int)> task);
  ~WorkerThreads();
  WorkerThreads(const WorkerThreads&) = delete;
  WorkerThreads& operator=(const WorkerThreads&) = delete;

  /// How many there are, the calling one included.
  int size() const { return static_cast<int>(threads_.size()) + 1; }

  /// Does the tasks 0 <= i < count, count <= size(), the first in the calling thread, and waits for
  /// all of them.
  void run(int count);

 private:
  void work(int index);

  std::function<void(int)> task_;
  std::mutex mutex_;
  std::condition_variable begin_;
  std::condition_variable done_;
  std::int64_t run_ = 0;  ///< counts the calls of `run`
  int count_ = 0;         ///< tasks of this run
  int unfinished_ = 0;    ///< of these, how many other threads have still to do
  bool stop_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace spring_pendulum
