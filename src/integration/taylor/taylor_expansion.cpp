#include "integration/taylor/taylor_expansion.hpp"

#include <algorithm>

namespace spring_pendulum {

TaylorExpansion::TaylorExpansion(const Chain& chain, int order) {
  work_.spring = chain.spring();
  work_.gravity = chain.gravity();
  work_.size = chain.size();
  work_.pitch = StateBuffer::paddedSize(chain.size());
  work_.order = order;
  inverse_masses_ = AlignedNumbers(work_.pitch);
  std::copy_n(chain.inverseMasses().data(), chain.size(), inverse_masses_.data());
  springs_ = AlignedNumbers(TaylorWorkspace::springNumbers(work_.pitch, order));
  accelerations_ = AlignedNumbers(TaylorWorkspace::accelerationNumbers(work_.pitch, order));
  work_.inverse_masses = inverse_masses_.data();
  work_.springs = springs_.data();
  work_.accelerations = accelerations_.data();
}

TaylorWeights taylorWeights(std::ptrdiff_t count, double time) {
  TaylorWeights weights;
  weights.count = count;
  weights.start_velocity = time;
  double power = time;
  for (std::ptrdiff_t n = 0; n < count; ++n) {
    const auto i = static_cast<std::size_t>(n);
    weights.velocity[i] = power / static_cast<double>(n + 1);
    power *= time;
    weights.position[i] = power / (static_cast<double>(n + 1) * static_cast<double>(n + 2));
  }
  return weights;
}

}  // namespace spring_pendulum
