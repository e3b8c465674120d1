#include "integration/fixed_step/plain_runge_kutta.hpp"

namespace spring_pendulum {

PlainRungeKutta::PlainRungeKutta(const Chain& chain, const ButcherTableau& tableau,
                                 bool track_dissipation, const ChainKernels& kernels)
    : SteppedIntegrator(chain, track_dissipation, kernels),
      tableau_(tableau),
      stage_(chain.size()) {
  for (std::size_t i = 0; i < tableau.stages; ++i) slopes_.emplace_back(chain.size());
}

void PlainRungeKutta::step(double time_step) {
  const Eigen::Index pitch = current().pitch();
  for (std::size_t i = 0; i < tableau_.stages; ++i) {
    kernels_.combine(pitch, current().data(), stageSum(time_step, tableau_.a[i], slopes_),
                     stage_.data());
    evaluate(stage_, slopes_[i]);
    if (tableau_.b[i] != 0.0) addPowers(stage_, time_step * tableau_.b[i]);
  }
  kernels_.combine(pitch, current().data(), stageSum(time_step, tableau_.b, slopes_),
                   current().data());
  held_.place(current().values(), 1);
  if (tableau_.stages == 1) trapezoidalRule(stage_, current(), time_step);
}

}  // namespace spring_pendulum
