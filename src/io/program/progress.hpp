// The progress of a long computation: "4711 of 100000 frames, 5 %, 9200 per second, 10 s left".
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace spring_pendulum {

/// On a terminal, a line that is replaced every second; elsewhere, a new line per minute.
class Progress {
 public:
  /// \param unit what is counted, in the plural
  Progress(std::int64_t total, std::string unit);
  /// Clears the line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// \param done of the total, including what was done before the first call
  void show(std::int64_t done);

 private:
  using Clock = std::chrono::steady_clock;
  std::int64_t total_;
  std::string unit_;
  bool is_terminal_;
  bool is_visible_ = false;
  std::chrono::seconds delay_;
  std::int64_t done_before_ = -1;  ///< in the first call; -1: not called yet
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_time_;
};

}  // namespace spring_pendulum
