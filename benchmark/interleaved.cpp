#include "interleaved.hpp"

#include <algorithm>

#include "stopwatch.hpp"

namespace spring_pendulum::benchmark {

std::vector<Timing> timeInTurns(const std::vector<Work>& pieces, int rounds, Time time) {
  std::vector<std::vector<double>> samples(pieces.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (pieces[i].before) pieces[i].before();
      const Stopwatch stopwatch;
      pieces[i].work();
      samples[i].push_back(time == Time::kAlone ? stopwatch.alone() : stopwatch.elapsed());
    }
  }
  std::vector<Timing> timings;
  for (std::vector<double>& of_one : samples) {
    std::sort(of_one.begin(), of_one.end());
    timings.push_back({of_one[of_one.size() / 2], of_one.front()});
  }
  return timings;
}

}  // namespace spring_pendulum::benchmark
