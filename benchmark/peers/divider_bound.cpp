#include "divider_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "../stopwatch.hpp"

namespace spring_pendulum::benchmark {
namespace {

void invertRoots(const std::vector<double>& squares, std::vector<double>& results) {
  const double* __restrict q = squares.data();
  double* __restrict r = results.data();
  const std::size_t n = squares.size();
#pragma GCC ivdep
  for (std::size_t i = 0; i < n; ++i) r[i] = 1.0 / std::sqrt(q[i]);
}

}  // namespace

double dividerBound() {
  constexpr std::size_t kNumbers = 1024;
  constexpr int kRepeats = 100;
  std::vector<double> squares(kNumbers, 1.5);
  std::vector<double> results(kNumbers);
  double least = std::numeric_limits<double>::infinity();
  for (int run = 0; run < 200; ++run) {
    const Stopwatch stopwatch;
    for (int i = 0; i < kRepeats; ++i) {
      invertRoots(squares, results);
      std::swap(squares, results);  // so that the compiler keeps every repetition
    }
    least = std::min(least, stopwatch.alone());
  }
  return 1e9 * least / (kRepeats * kNumbers);
}

}  // namespace spring_pendulum::benchmark
