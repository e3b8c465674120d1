#include "integration/taylor/taylor_expansion.hpp"

#include <array>
#include <cstddef>

namespace spring_pendulum {
namespace {

/// The reciprocals 1/i, which save divisions; element 0 is not used.
constexpr auto kReciprocals = [] {
  std::array<double, kLargestTaylorOrder + 2> reciprocals{};
  for (std::size_t i = 1; i < reciprocals.size(); ++i) {
    reciprocals[i] = 1.0 / static_cast<double>(i);
  }
  return reciprocals;
}();

}  // namespace

TaylorExpansion::TaylorExpansion(const KernelChain& chain, int order)
    : inverse_masses_(chain.pitch),
      left_inverse_masses_(chain.pitch),
      springs_(TaylorWorkspace::springNumbers(chain.pitch)),
      accelerations_(TaylorWorkspace::accelerationNumbers(chain.pitch, order)),
      work_{chain, left_inverse_masses_.data(), order, springs_.data(), accelerations_.data()} {
  for (std::ptrdiff_t i = 0; i + 1 < chain.size; ++i) {
    inverse_masses_[i] = chain.inverse_masses[chain.mass_stride * i];
    if (i + 2 < chain.size) left_inverse_masses_[i + 1] = inverse_masses_[i];
  }
  work_.chain.inverse_masses = inverse_masses_.data();
  work_.chain.mass_stride = 1;
}

TaylorWeights taylorWeights(std::ptrdiff_t count, double time) {
  TaylorWeights weights;
  weights.count = count;
  weights.start_velocity = time;
  double power = time;
  for (std::size_t n = 0; n < static_cast<std::size_t>(count); ++n) {
    weights.velocity[n] = power * kReciprocals[n + 1];
    power *= time;
    weights.position[n] = power * (kReciprocals[n + 1] * kReciprocals[n + 2]);
  }
  return weights;
}

}  // namespace spring_pendulum
