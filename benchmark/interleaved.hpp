// Times several pieces of work in turns, so that a disturbance of the machine affects all of them
// and their ratios remain valid. (Google Benchmark finishes one before it begins the next.)
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace spring_pendulum::benchmark {

struct Work {
  std::string name;
  std::function<void()> before;  ///< not timed; may be empty
  std::function<void()> work;    ///< timed
};

struct Timing {
  double median = 0.0;  ///< s
  double least = 0.0;   ///< s
};

enum class Time {
  kElapsed,  ///< wall-clock time
  kAlone     ///< without waiting for a processor; see Stopwatch::alone
};

/// Returns a timing for each piece of work; each runs once per round.
std::vector<Timing> timeInTurns(const std::vector<Work>& pieces, int rounds, Time time);

}  // namespace spring_pendulum::benchmark
