#include "integration/taylor/taylor_stepper.hpp"

#include "integration/kernels/state_buffer.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/model/energy.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "support/reference.hpp"

namespace spring_pendulum {
namespace {

using test::positionError;
using test::referenceScene;
using test::referenceSolution;
using test::Scene;

State afterFixedSteps(TaylorStepper& series, const Scene& scene, int seconds,
                      int steps_per_second) {
  series.start(scene.start);
  for (int n = 0; n < seconds * steps_per_second; ++n) series.stepBy(1.0 / steps_per_second);
  State state(scene.start.size());
  state.values() = series.stateAt(1.0).values();
  return state;
}

struct OrderCase {
  int order;
  int steps_per_second;  ///< enough to show the order when the step is halved
};

TEST(TaylorStepper, OrderIsTheSlopeOfTheErrorFromBothSides) {
  for (const char* name : {"single_vertical", "two_masses_45deg", "horizontal_11"}) {
    const Scene scene = referenceScene(name);
    const State exact = referenceSolution(name, 2);
    for (const OrderCase& c : {OrderCase{4, 64}, OrderCase{6, 32}, OrderCase{10, 12}}) {
      TaylorStepper series(scene.chain, c.order, 1e-6);
      const double coarse =
          positionError(afterFixedSteps(series, scene, 2, c.steps_per_second), exact);
      const double fine =
          positionError(afterFixedSteps(series, scene, 2, 2 * c.steps_per_second), exact);
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
    for (const double filler : {0.0, 1e-16}) {
      for (int gaps = 1; gaps < 15; ++gaps) {
        LastCoefficients last = whole;
        for (int i = 0; i < 4; ++i) {
          if ((gaps & (1 << i)) != 0) last.size[i] *= filler * (1 + i);
        }
        EXPECT_LT(longestAccurateStep(last, 8, 1e-8), 2.0 * step) << growth << " " << gaps;
      }
    }
  }
}

// The local error of the dense output is of order K + 1 in the velocities everywhere in the step.
TEST(TaylorStepper, DenseOutputHasTheOrderToo) {
  const Scene scene = referenceScene("two_masses_45deg");
  for (const int order : {4, 6}) {
    double errors[2] = {};
    for (int halvings = 0; halvings < 2; ++halvings) {
      TaylorStepper series(scene.chain, order, 1e-6);
      TaylorStepper fine(scene.chain, 14, 1e-6);
      const double h = 0.1 / (1 << halvings);
      series.start(scene.start);
      series.stepBy(h);
      State inside(3), exact(3);
      for (const double fraction : {0.3, 0.7, 1.0}) {
        inside.values() = series.stateAt(fraction).values();
        fine.start(scene.start);
        for (int n = 0; n < 4; ++n) fine.stepBy(0.25 * fraction * h);
        exact.values() = fine.stateAt(1.0).values();
        errors[halvings] = std::max(
            errors[halvings], (inside.velocities() - exact.velocities()).cwiseAbs().maxCoeff());
      }
    }
    const double slope = std::log2(errors[0] / errors[1]);
    EXPECT_GT(slope, order + 0.7) << order;  // measured: 4.9 (4), 6.9 (6)
    EXPECT_LT(slope, order + 1.3) << order;
  }
}

TEST(TaylorStepper, DenseOutputJoinsTheStepsWithoutAGap) {
  const Scene scene = referenceScene("horizontal_11");
  TaylorStepper series(scene.chain, 6, 1e-6);
  series.start(scene.start);
  State end = scene.start;
  State begin(scene.start.size());
  for (int n = 0; n < 5; ++n) {
    series.stepBy(0.05);
    begin.values() = series.stateAt(0.0).values();
    EXPECT_EQ(begin.values(), end.values());
    end.values() = series.stateAt(1.0).values();
    begin.values() = series.stateAt(1.0 - 1e-12).values();
    EXPECT_LT((begin.values() - end.values()).cwiseAbs().maxCoeff(), 1e-11);  // measured: 5e-13
  }
}

// A step so short that only the first coefficient matters shows the accelerations.
TEST(TaylorStepper, BeginsWithTheAccelerationsOfTheModel) {
  const Scene scene = referenceScene("horizontal_11");
  const State state = referenceSolution("horizontal_11", 5);
  State slope;
  computeSlope(scene.chain, state, slope);
  TaylorStepper series(scene.chain, 4, 1e-6);
  series.start(state);
  const double h = 1e-6;
  series.stepBy(h);
  State after(state.size());
  after.values() = series.stateAt(1.0).values();
  const State::PlaneMatrix measured = (after.velocities() - state.velocities()) / h;
  EXPECT_LT((measured - slope.velocities()).cwiseAbs().maxCoeff(), 1e-3);  // measured: 6e-5, of 14
}

// The stability function of order K is the Taylor polynomial of exp.
TEST(TaylorStepper, StabilityLimitsOfTheTableAreThoseOfItsPolynomial) {
  const auto amplification = [](int order, std::complex<double> z) {
    std::complex<double> sum = 1.0, term = 1.0;
    for (int n = 1; n <= order; ++n) sum += term *= z / static_cast<double>(n);
    return std::abs(sum);
  };
  for (const Method& method : methodTable()) {
    if (method.name.substr(0, 6) != "Taylor") continue;
    const double real = method.real_stability_limit;
    EXPECT_LE(amplification(method.order, -real), 1.0 + 1e-9) << method.name;
    EXPECT_GT(amplification(method.order, -1.0001 * real), 1.0) << method.name;
    const double imaginary = method.imaginary_stability_limit;
    const std::complex<double> i(0.0, 1.0);
    for (int k = 0; k <= 1000; ++k) {
      EXPECT_LE(amplification(method.order, 0.001 * k * imaginary * i), 1.0 + 1e-9) << method.name;
    }
    EXPECT_GT(amplification(method.order, (1.0001 * imaginary + 1e-2) * i), 1.0) << method.name;
  }
}

// The kernels over the whole chain, with the lengths of step that the stepper chose.
TEST(TaylorStepper, LeavingOutTheFreelyFallingEndChangesNoBit) {
  for (const char* name : {"horizontal_11", "light_100", "horizontal_1000"}) {
    const Scene scene = referenceScene(name);
    const Eigen::Index size = scene.start.size();
    const KernelConstants constants(scene.chain);
    const TaylorExpansion expansion(constants.chain(), 8);
    const TaylorWorkspace& work = expansion.work();
    StateBuffer whole(size);
    whole.values() = scene.start.values();

    TaylorStepper series(scene.chain, 8, 1e-6);
    series.start(scene.start);
    State state(size);
    for (int n = 0; n < 40; ++n) {
      const double h = series.step();
      fastestChainKernels().taylorSeries(work, whole.data());
      fastestChainKernels().taylorState(work, whole.data(), whole.data(), taylorWeights(8, h),
                                        whole.data());
      state.values() = series.stateAt(1.0).values();
      ASSERT_EQ(state.values(), State::Matrix(whole.values())) << name << " " << n;
    }
  }
}

// A particle moves up through the anchor, where the spring force is discontinuous. The series does
// not represent the jump; the energy shows whether the step-size control handles it.
TEST(TaylorStepper, StopsWhereASpringHasNoLength) {
  for (const double sideways : {0.0, 1e-9}) {
    const Chain chain(Eigen::VectorXd::Ones(2), SpringLaw{50.0, 0.0, 1.0}, 9.81);
    State state(2);
    state.y()[1] = -1.0;
    state.x()[1] = sideways;
    state.vy()[1] = 12.0;
    const double energy = computeEnergy(chain, state).total();
    TaylorStepper series(chain, 10, 1e-9);
    series.start(state);
    int crossings = 0;
    double time = 0.0;
    for (double below = state.y()[1]; time < 2.0; below = state.y()[1]) {
      const double h = series.step();
      ASSERT_GT(h, 0.0);
      time += h;
      state.values() = series.stateAt(1.0).values();
      if (below * state.y()[1] < 0.0) ++crossings;
    }
    EXPECT_GT(crossings, 1) << sideways;
    EXPECT_NEAR(computeEnergy(chain, state).total(), energy, 2e-8) << sideways;  // of 62 J: 1.8e-9
    EXPECT_LT(series.statistics().accepted, 2000) << sideways;
  }
}

TEST(TaylorStepper, ShowsThatItDiverged) {
  const Scene scene = referenceScene("two_masses_45deg");
  State state = scene.start;
  state.vx()[1] = 1e200;
  TaylorStepper series(scene.chain, 6, 1e-6);
  series.start(state);
  EXPECT_EQ(series.step(), 0.0);
}

}  // namespace
}  // namespace spring_pendulum
