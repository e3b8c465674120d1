#include "integration/fixed_step/plain_runge_kutta.hpp"

#include <spring_pendulum/model/dynamics.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "support/reference.hpp"

namespace spring_pendulum {
namespace {

/// A tableau without a kernel that needs every slope: the 3/8 rule.
const ButcherTableau kThreeEighths{4,
                                   {{{}, {1.0 / 3.0}, {-1.0 / 3.0, 1.0}, {1.0, -1.0, 1.0}}},
                                   {1.0 / 8.0, 3.0 / 8.0, 3.0 / 8.0, 1.0 / 8.0}};

void addWeighted(double weight, const State& slope, State& to) {
  for (Eigen::Index i = 0; i < to.values().size(); ++i) {
    double& sum = to.values().data()[i];
    sum = std::fma(weight, slope.values().data()[i], sum);
  }
}

/// One step as the formula is written.
void stepByTheFormula(const Chain& chain, const ButcherTableau& tableau, double h, State& state) {
  std::vector<State> slopes(tableau.stages, State(chain.size()));
  for (std::size_t i = 0; i < tableau.stages; ++i) {
    State stage = state;
    for (std::size_t j = 0; j < i; ++j)
      if (tableau.a[i][j] != 0.0) addWeighted(h * tableau.a[i][j], slopes[j], stage);
    computeSlope(chain, stage, slopes[i]);
  }
  for (std::size_t i = 0; i < tableau.stages; ++i)
    if (tableau.b[i] != 0.0) addWeighted(h * tableau.b[i], slopes[i], state);
}

TEST(PlainRungeKutta, HasTheBitsOfTheFormula) {
  for (const ButcherTableau& tableau : {kClassicalRungeKuttaTableau, kThreeEighths}) {
    const test::Scene scene = test::referenceScene("horizontal_11");
    State expected = scene.start;
    for (int n = 0; n < 50; ++n) stepByTheFormula(scene.chain, tableau, 0.01, expected);
    for (const ChainKernels* kernels : supportedChainKernels()) {
      PlainRungeKutta plain(scene.chain, tableau, false, *kernels);
      State state = scene.start;
      plain.advance(state, 0.01, 50);
      EXPECT_EQ(std::memcmp(state.values().data(), expected.values().data(),
                            sizeof(double) * static_cast<std::size_t>(state.values().size())),
                0)
          << kernels->name;
    }
  }
}

}  // namespace
}  // namespace spring_pendulum
