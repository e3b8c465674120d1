// The error-controlled methods have the same bits whatever instruction set their kernels are for.
#include "integration/embedded/embedded_runge_kutta_stepper.hpp"
#include "integration/implicit/radau_stepper.hpp"
#include "integration/taylor/stabilized_taylor_stepper.hpp"
#include "integration/taylor/taylor_stepper.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>

#include "support/reference.hpp"

namespace spring_pendulum {
namespace {

struct Maker {
  const char* name;
  std::unique_ptr<DenseOutputStepper> (*make)(const Chain&, const ChainKernels&);
};

template <typename Stepper, int... kOrder>
std::unique_ptr<DenseOutputStepper> make(const Chain& chain, const ChainKernels& kernels) {
  return std::make_unique<Stepper>(chain, kOrder..., 1e-5, kernels);
}

constexpr Maker kMakers[] = {{"Taylor_7", make<TaylorStepper, 7>},
                             {"Taylor_12", make<TaylorStepper, 12>},
                             {"Stabilized_Taylor_4", make<StabilizedTaylorStepper, 4>},
                             {"Stabilized_Taylor_8", make<StabilizedTaylorStepper, 8>},
                             {"Dormand_Prince_5", make<EmbeddedRungeKuttaStepper>},
                             {"Radau_9", make<RadauStepper>}};

State stateAfterSteps(const test::Scene& scene, const Maker& maker, const ChainKernels& kernels) {
  const auto stepper = maker.make(scene.chain, kernels);
  stepper->start(scene.start);
  for (int n = 0; n < 100; ++n) EXPECT_GT(stepper->step(), 0.0);
  State state(scene.start.size());
  state.values() = stepper->stateAt(0.3).values();
  return state;
}

class OnEveryInstructionSet : public testing::TestWithParam<Maker> {};

TEST_P(OnEveryInstructionSet, HasTheSameBits) {
  for (const char* name : {"two_masses_45deg", "horizontal_11", "lighter_100"}) {
    const test::Scene scene = test::referenceScene(name);
    const State wanted = stateAfterSteps(scene, GetParam(), *supportedChainKernels().back());
    for (const ChainKernels* kernels : supportedChainKernels()) {
      const State state = stateAfterSteps(scene, GetParam(), *kernels);
      EXPECT_EQ(std::memcmp(state.values().data(), wanted.values().data(),
                            sizeof(double) * static_cast<std::size_t>(wanted.values().size())),
                0)
          << name << " " << kernels->name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, OnEveryInstructionSet, testing::ValuesIn(kMakers),
                         [](const auto& method) { return std::string(method.param.name); });

}  // namespace
}  // namespace spring_pendulum
