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

  /// Time in s without waiting for a processor, for work that neither starts threads nor waits for
  /// a file. Below 1 ms it is the wall-clock time: a short run rarely waits, and on a virtual
  /// machine the processor clock can be wrong by some microseconds.
  double alone() const {
    const double wall = elapsed();
    return wall < 1e-3 ? wall : std::min(wall, processorTime() - processor_start_);
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
