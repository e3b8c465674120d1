#include "integration/taylor/taylor_expansion.hpp"

#include "integration/kernels/kernel_constants.hpp"

#include <algorithm>
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

TaylorExpansion::TaylorExpansion(const Chain& chain, int order) {
  work_.spring = chain.spring();
  work_.gravity = chain.isDriven() ? 0.0 : chain.gravity();
  drive_ = driveColumns(chain);
  work_.drive = chain.isDriven() ? drive_.data() : nullptr;
  drag_rates_ = dragRates(chain);
  if (chain.airDrag() != 0.0) work_.drag_rates = drag_rates_.data();
  work_.size = chain.size();
  work_.pitch = StateBuffer::pitchFor(chain.size());
  work_.order = order;
  const std::ptrdiff_t moving = chain.size() - 1;
  inverse_masses_ = AlignedNumbers(work_.pitch);
  std::copy_n(chain.inverseMasses().data() + 1, moving, inverse_masses_.data());
  left_inverse_masses_ = AlignedNumbers(work_.pitch);
  std::copy_n(chain.inverseMasses().data(), moving, left_inverse_masses_.data());
  springs_ = AlignedNumbers(TaylorWorkspace::springNumbers(work_.pitch));
  accelerations_ = AlignedNumbers(TaylorWorkspace::accelerationNumbers(work_.pitch, order));
  work_.inverse_masses = inverse_masses_.data();
  work_.left_inverse_masses = left_inverse_masses_.data();
  work_.springs = springs_.data();
  work_.accelerations = accelerations_.data();
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
