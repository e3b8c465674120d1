#include "interleaved.hpp"

#include <algorithm>
#include <chrono>

namespace spring_pendulum::benchmark {

std::vector<Timing> timeInTurns(const std::vector<Work>& pieces, int rounds) {
  std::vector<std::vector<double>> samples(pieces.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (pieces[i].before) pieces[i].before();
      const auto start = std::chrono::steady_clock::now();
      pieces[i].work();
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
      samples[i].push_back(spent.count());
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
