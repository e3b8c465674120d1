// The progress of a sweep on standard error: "4711 of 100000 cases, 5 %, 9200 per second, 10 s left".
#pragma once

#include <chrono>
#include <cstdint>

namespace spring_pendulum::sweep {

/// A line that is replaced five times per second on a terminal, else a new line per minute.
class SweepProgress {
 public:
  explicit SweepProgress(std::int64_t cases);
  /// Clears the line.
  ~SweepProgress();
  SweepProgress(const SweepProgress&) = delete;
  SweepProgress& operator=(const SweepProgress&) = delete;

  void show(std::int64_t cases_done);
  /// Time since construction, s.
  double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;
  std::int64_t cases_;
  bool is_terminal_;
  bool is_visible_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_time_;
};

}  // namespace spring_pendulum::sweep
