#include "integration/fixed_step/worker_threads.hpp"

#include <cassert>
#include <system_error>
#include <utility>

namespace spring_pendulum {

WorkerThreads::WorkerThreads(int threads, std::function<void(int)> task) : task_(std::move(task)) {
  for (int index = 1; index < threads; ++index) {
    try {
      threads_.emplace_back([this, index] { work(index); });
    } catch (const std::system_error&) {
      return;
    }
  }
}

WorkerThreads::~WorkerThreads() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  begin_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void WorkerThreads::run(int count) {
  assert(1 <= count && count <= size());
  if (count == 1) return task_(0);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++run_;
    count_ = count;
    unfinished_ = count - 1;
  }
  begin_.notify_all();
  task_(0);
  std::unique_lock<std::mutex> lock(mutex_);
  done_.wait(lock, [this] { return unfinished_ == 0; });
}

void WorkerThreads::work(int index) {
  std::int64_t last_run = 0;
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    begin_.wait(lock, [&] { return stop_ || run_ != last_run; });
    if (stop_) return;
    last_run = run_;
    if (index >= count_) continue;
    lock.unlock();
    task_(index);
    lock.lock();
    if (--unfinished_ == 0) done_.notify_one();
  }
}

}  // namespace spring_pendulum
