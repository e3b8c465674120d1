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
  std::unique_ptr<DenseOutputStepper> (*make)(const Chain&, double, const ChainKernels&);
};

template <int order>
std::unique_ptr<DenseOutputStepper> makeTaylor(const Chain& chain, double tolerance,
                                               const ChainKernels& kernels) {
  return std::make_unique<TaylorStepper>(chain, order, tolerance, kernels);
}

template <int order>
std::unique_ptr<DenseOutputStepper> makeStabilized(const Chain& chain, double tolerance,
                                                   const ChainKernels& kernels) {
  return std::make_unique<StabilizedTaylorStepper>(chain, order, tolerance, kernels);
}

template <const EmbeddedPair& kPair>
std::unique_ptr<DenseOutputStepper> makePair(const Chain& chain, double tolerance,
                                             const ChainKernels& kernels) {
  return std::make_unique<EmbeddedRungeKuttaStepper>(chain, &kPair, tolerance, kernels);
}

std::unique_ptr<DenseOutputStepper> makeRadau(const Chain& chain, double tolerance,
                                              const ChainKernels& kernels) {
  return std::make_unique<RadauStepper>(chain, tolerance, kernels);
}

constexpr Maker kMakers[] = {{"Taylor-7", makeTaylor<7>},
                             {"Taylor-12", makeTaylor<12>},
                             {"Stabilized-Taylor-4", makeStabilized<4>},
                             {"Stabilized-Taylor-8", makeStabilized<8>},
                             {"Dormand-Prince-5", makePair<kDormandPrince5>},
                             {"Radau-9", makeRadau}};

State stateAfterSteps(const test::Scene& scene, const Maker& maker, const ChainKernels& kernels) {
  const auto stepper = maker.make(scene.chain, 1e-5, kernels);
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
                         [](const testing::TestParamInfo<Maker>& method) {
                           std::string name = method.param.name;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace spring_pendulum
