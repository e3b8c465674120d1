// Measures the time of work on a shared machine.
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>

namespace spring_pendulum::benchmark {

class Stopwatch {
 public:
  /// Wall-clock time, s.
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  /// Time in s without waiting for a processor; for work that neither starts threads nor waits for
  /// a file. Equals `elapsed` on an idle machine and never exceeds it, as the clocks are read in
  /// this order.
  double alone() const {
    const double wall = elapsed();
    const double used = processorTime() - processor_start_;
    return used > 0.0 ? std::min(wall, used)
                      : wall;  // on a busy virtual machine it can stand still
  }

 private:
  using Clock = std::chrono::steady_clock;

  static double processorTime() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  double processor_start_ = processorTime();
  Clock::time_point start_ = Clock::now();
};

}  // namespace spring_pendulum::benchmark
