#include "integration/taylor/taylor_stepper.hpp"

#include "integration/kernels/kernel_data.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/reference.hpp"

namespace spring_pendulum::test {
namespace {

/// Steps of a fixed size, of the whole chain.
class FixedSteps {
 public:
  FixedSteps(const Scene& scene, int order)
      : constants_(scene.chain), expansion_(constants_.chain(), order), state_(scene.chain.size()) {
    state_.values() = scene.start.values();
  }
  void step(double h) {
    const TaylorWorkspace& work = expansion_.work;
    fastestChainKernels().taylorSeries(work, state_.data());
    fastestChainKernels().taylorState(work, state_.data(), state_.data(),
                                      taylorWeights(work.order, h), state_.data());
  }
  State state() const {
    State state(state_.size());
    state.values() = state_.values();
    return state;
  }

 private:
  KernelConstants constants_;
  TaylorExpansion expansion_;
  StateBuffer state_;
};

double errorOfFixedSteps(const Scene& scene, int order, int steps_per_second) {
  FixedSteps series(scene, order);
  for (int n = 0; n < 2 * steps_per_second; ++n) series.step(1.0 / steps_per_second);
  return positionError(series.state(), referenceSolution(scene.name, 2));
}

struct OrderCase {
  int order;
  int steps_per_second;  ///< enough to show the order when the step is halved
};

TEST(TaylorStepper, OrderIsTheSlopeOfTheErrorFromBothSides) {
  for (const char* name : {"single_vertical", "two_masses_45deg", "horizontal_11"}) {
    const Scene scene = referenceScene(name);
    for (const OrderCase& c : {OrderCase{4, 64}, OrderCase{6, 32}, OrderCase{10, 12}}) {
      const double coarse = errorOfFixedSteps(scene, c.order, c.steps_per_second);
      const double fine = errorOfFixedSteps(scene, c.order, 2 * c.steps_per_second);
      // Measured: 10.2 to 11.2 for order 10, within 0.06 for the others.
      const double allowance = c.order == 10 ? 1.4 : 0.2;
      EXPECT_NEAR(std::log2(coarse / fine), c.order, allowance) << name << " " << c.order;
    }
  }
}

// The coefficients A g^n grow by g. Zeros and rounding errors in any places must not lengthen the step.
TEST(TaylorStepper, GapsInTheSeriesDoNotLengthenTheStep) {
  for (const double growth : {0.1, 12.0, 1e3}) {
    LastCoefficients whole{};
    for (int i = 0; i < 4; ++i) whole.size[i] = 10.0 * std::pow(growth, 7 - i);
    const double step = longestAccurateStep(whole, 8, 1e-8);
    for (const double filler : {0.0, 1e-16})
      for (int gaps = 1; gaps < 15; ++gaps) {
        LastCoefficients last = whole;
        for (int i = 0; i < 4; ++i)
          if ((gaps & (1 << i)) != 0) last.size[i] *= filler * (1 + i);
        EXPECT_LT(longestAccurateStep(last, 8, 1e-8), 2.0 * step) << growth << " " << gaps;
      }
  }
}

// The kernels over the whole chain, with the lengths of step that the stepper chose.
TEST(TaylorStepper, LeavingOutTheFreelyFallingEndChangesNoBit) {
  for (const char* name : {"horizontal_11", "light_100", "horizontal_1000"}) {
    const Scene scene = referenceScene(name);
    FixedSteps whole(scene, 8);
    TaylorStepper series(scene.chain, 8, 1e-6);
    series.start(scene.start);
    State state = scene.start;
    for (int n = 0; n < 40; ++n) {
      whole.step(series.step());
      state.values() = series.stateAt(1.0).values();
      ASSERT_EQ(state.values(), whole.state().values()) << name << " " << n;
    }
  }
}

TEST(TaylorStepper, ShowsThatItDiverged) {
  const Scene scene = referenceScene("two_masses_45deg");
  State state = scene.start;
  state.vx()[1] = 1e200;
  TaylorStepper series(scene.chain, 6, 1e-6);
  series.start(state);
  series.step();  // its coefficients overflow, its state does not
  EXPECT_EQ(series.step(), 0.0);
}

}  // namespace
}  // namespace spring_pendulum::test
