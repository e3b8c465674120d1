#include "simulation/advice/step_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

constexpr double kRatio = 1.01;  ///< ratio of neighbouring step sizes on the grid
constexpr int kStride = 32;      ///< stride of the coarse search, in grid points
/// Number of grid points below the result that must pass as well, because nearly undamped chains
/// have narrow intervals of unstable step sizes.
constexpr int kLookBack = 20;

}  // namespace

double roundedDown(double step) {
  const double unit = std::pow(10.0, std::floor(std::log10(step)) - 2.0);
  return std::isnormal(unit) ? std::floor(step / unit * (1.0 + 1e-9)) * unit : step;
}

double largestPassingStep(double first, double least, double most,
                          const std::function<bool(double)>& passes) {
  if (!(least <= most)) return 0.0;
  const double origin = std::clamp(first, least, most);
  const auto step = [&](int i) { return roundedDown(origin * std::pow(kRatio, i)); };
  const auto isTried = [&](int i) { return step(i) >= roundedDown(least); };
  const auto descend = [&](int i, int stride) {
    while (isTried(i) && !passes(step(i))) i -= stride;
    return i;
  };
  // Whether a share of a grid point passes, as far as it can be tried.
  const auto sharePasses = [&](int i, double share) {
    return share * step(i) < least || passes(share * step(i));
  };
  int good = descend(0, kStride);
  if (!isTried(good)) return 0.0;
  int bad = good + kStride;
  while (step(bad) <= most && passes(step(bad))) bad += kStride;
  if (step(bad) > most) return std::numeric_limits<double>::infinity();
  good = bad - kStride;
  while (bad - good > 1) {
    const int middle = good + (bad - good) / 2;
    (passes(step(middle)) ? good : bad) = middle;
  }
  // Each failure below the limit doubles the stride, so that few steps are tried in any case.
  for (int stride = 1; isTried(good); stride *= 2) {
    int i = good - 1;
    while (i >= good - kLookBack && isTried(i) && passes(step(i))) --i;
    const bool all_pass = i < good - kLookBack || !isTried(i);
    if (all_pass && sharePasses(good, 0.95) && sharePasses(good, 0.9)) return step(good);
    good = descend((all_pass ? good : i) - stride, stride);
  }
  return 0.0;
}

}  // namespace spring_pendulum
