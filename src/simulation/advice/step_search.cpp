#include "simulation/advice/step_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace spring_pendulum {
namespace {

constexpr double kRatio = 1.01;  ///< ratio of neighbouring step sizes on the grid
constexpr int kStride = 32;      ///< stride of the coarse search, in grid points
/// Number of grid points below the result that must pass as well, because nearly undamped chains
/// have narrow intervals of unstable step sizes.
constexpr int kLookBack = 20;

/// A geometric grid of step sizes.
class Grid {
 public:
  Grid(double first, double least, const std::function<bool(double)>& passes)
      : first_(first), least_(roundedDown(least)), passes_(passes) {}

  double step(int i) const { return roundedDown(first_ * std::pow(kRatio, i)); }
  bool isTooSmall(int i) const { return step(i) < least_; }
  bool passes(int i) const { return passes_(step(i)); }

  /// Returns the first of the points i, i - stride, ... that passes or is too small.
  int descend(int i, int stride) const {
    while (!isTooSmall(i) && !passes(i)) i -= stride;
    return i;
  }

  /// Returns a failing point just below `good`, or `good` if 0.95 or 0.9 times its step size, the
  /// usual safety margins, fail.
  std::optional<int> failureBelow(int good) const {
    for (int i = good - 1; i >= good - kLookBack && !isTooSmall(i); --i) {
      if (!passes(i)) return i;
    }
    for (const double share : {0.95, 0.9}) {
      if (share * step(good) >= least_ && !passes_(share * step(good))) return good;
    }
    return std::nullopt;
  }

 private:
  double first_;
  double least_;
  const std::function<bool(double)>& passes_;
};

}  // namespace

double roundedDown(double step) {
  const double unit = std::pow(10.0, std::floor(std::log10(step)) - 2.0);
  return std::isnormal(unit) ? std::floor(step / unit * (1.0 + 1e-9)) * unit : step;
}

double largestPassingStep(double first, double least, double most,
                          const std::function<bool(double)>& passes) {
  if (!(least <= most)) return 0.0;
  const Grid grid(std::clamp(first, least, most), least, passes);
  int good = grid.descend(0, kStride);
  for (const int i : {-kStride, -2 * kStride}) {
    if (good == 0 && !grid.isTooSmall(i)) good = grid.passes(i) ? 0 : grid.descend(i, kStride);
  }
  if (grid.isTooSmall(good)) return 0.0;
  int bad = good + kStride;
  while (grid.step(bad) <= most && grid.passes(bad)) bad += kStride;
  if (grid.step(bad) > most) return std::numeric_limits<double>::infinity();
  good = bad - kStride;
  while (bad - good > 1) {
    const int middle = good + (bad - good) / 2;
    (grid.passes(middle) ? good : bad) = middle;
  }
  for (int stride = 1; !grid.isTooSmall(good); stride *= 2) {
    const std::optional<int> failure = grid.failureBelow(good);
    if (!failure) return grid.step(good);
    good = grid.descend(*failure - stride, stride);
  }
  return 0.0;
}

}  // namespace spring_pendulum
