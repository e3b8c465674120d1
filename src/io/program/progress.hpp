// The progress of a long run, as a line on the terminal.
#pragma once

#include <chrono>
#include <cstdint>

namespace spring_pendulum {

/// Printed to standard error if that is a terminal and the run takes over a second.
class Progress {
 public:
  explicit Progress(std::int64_t frames);
  /// Clears the line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(std::int64_t frames_done);

 private:
  using Clock = std::chrono::steady_clock;
  std::int64_t frames_;
  bool is_terminal_;
  bool is_visible_ = false;
  Clock::time_point next_time_;
};

}  // namespace spring_pendulum
