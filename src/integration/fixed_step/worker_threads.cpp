#include "integration/fixed_step/worker_threads.hpp"

#include <algorithm>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace spring_pendulum {

WorkerThreads::WorkerThreads(int threads, std::function<void(int)> task) : task_(std::move(task)) {
  start(threads);
}

void WorkerThreads::start(int threads) {
  process_ = getpid();
  pool_ = std::make_unique<Pool>();
  for (int index = 1; index < threads; ++index) {
    try {
      pool_->threads.emplace_back([this, &pool = *pool_, index] { work(pool, index); });
    } catch (const std::system_error&) {
      return;
    }
  }
}

WorkerThreads::~WorkerThreads() {
  // To join the threads of a parent, or to destroy what they wait for, would take for ever.
  if (getpid() != process_) {
    static_cast<void>(pool_.release());
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(pool_->mutex);
    pool_->stop = true;
  }
  pool_->begin.notify_all();
  for (std::thread& thread : pool_->threads) thread.join();
}

void WorkerThreads::run(int count) {
  if (count == 1) return task_(0);
  if (getpid() != process_) {
    const int threads = size();
    static_cast<void>(pool_.release());
    start(threads);
  }
  Pool& pool = *pool_;
  {
    const std::lock_guard<std::mutex> lock(pool.mutex);
    ++pool.run;
    pool.count = count;
    pool.unfinished = std::min(count, size()) - 1;
  }
  pool.begin.notify_all();
  task_(0);
  for (int index = size(); index < count; ++index) task_(index);
  std::unique_lock<std::mutex> lock(pool.mutex);
  pool.done.wait(lock, [&pool] { return pool.unfinished == 0; });
}

void WorkerThreads::work(Pool& pool, int index) {
  std::int64_t last_run = 0;
  std::unique_lock<std::mutex> lock(pool.mutex);
  while (true) {
    pool.begin.wait(lock, [&] { return pool.stop || pool.run != last_run; });
    if (pool.stop) return;
    last_run = pool.run;
    if (index >= pool.count) continue;
    lock.unlock();
    task_(index);
    lock.lock();
    if (--pool.unfinished == 0) pool.done.notify_one();
  }
}

}  // namespace spring_pendulum
