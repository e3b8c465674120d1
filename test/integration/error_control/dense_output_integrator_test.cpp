#include "integration/error_control/dense_output_integrator.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace spring_pendulum {
namespace {

// A motion known at all times, x(t) = t + s of the start, in steps of 0.3 s; it diverges after a
// number of steps and dissipates 2 W in a chain of 2 N·s/m.
class UniformMotion : public DenseOutputStepper {
 public:
  explicit UniformMotion(int steps_until_divergence = 1000) : left_(steps_until_divergence) {}
  void start(const State& state) override { begin_ = end_ = state.x()[1]; }
  double step() override {
    if (left_-- == 0) return 0.0;
    begin_ = end_;
    end_ += kLength;
    ++statistics_.accepted;
    return kLength;
  }
  const StateBuffer& stateAt(double fraction) const override {
    state_.values()(1, 0) = begin_ + fraction * kLength;
    state_.values()(1, 2) = 1.0;
    return state_;
  }
  StepStatistics statistics() const override { return statistics_; }

 private:
  static constexpr double kLength = 0.3;
  int left_;
  double begin_ = 0.0, end_ = 0.0;
  mutable StateBuffer state_{2};
  StepStatistics statistics_;
};

Chain dampedChain() {
  return Chain(Eigen::VectorXd::Ones(2), SpringLaw{50.0, 2.0, 1.0}, 9.81);
}

TEST(DenseOutputIntegrator, ReadsTheOutputTimesOutOfItsOwnSteps) {
  DenseOutputIntegrator integrator(dampedChain(), std::make_unique<UniformMotion>(), true);
  State state(2);
  state.x()[1] = 10.0;
  integrator.advance(state, 0.05, 0);
  EXPECT_EQ(state.x()[1], 10.0);
  integrator.advance(state, 0.05, 1);
  EXPECT_NEAR(state.x()[1], 10.05, 1e-14);
  EXPECT_NEAR(integrator.dissipatedEnergy(), 0.1, 1e-14);
  integrator.advance(state, 0.05, 19);
  EXPECT_NEAR(state.x()[1], 11.0, 1e-14);
  EXPECT_NEAR(integrator.dissipatedEnergy(), 2.0, 1e-14);
  EXPECT_EQ(integrator.statistics().accepted, 4);  // 4 * 0.3 s > 1 s: none was shortened
}

TEST(DenseOutputIntegrator, GoesOnFromTheLastOutputTimeWithAnotherTimeStep) {
  DenseOutputIntegrator integrator(dampedChain(), std::make_unique<UniformMotion>(), true);
  State state(2);
  integrator.advance(state, 0.25, 3);
  integrator.advance(state, 0.1, 2);
  EXPECT_NEAR(state.x()[1], 0.95, 1e-14);
}

TEST(DenseOutputIntegrator, ShowsADivergedMotionInTheStateFromThenOn) {
  DenseOutputIntegrator integrator(dampedChain(), std::make_unique<UniformMotion>(2));
  State state(2);
  integrator.advance(state, 0.5, 1);
  EXPECT_NEAR(state.x()[1], 0.5, 1e-14);
  integrator.advance(state, 0.5, 1);
  EXPECT_TRUE(std::isnan(state.x()[1]));
  EXPECT_EQ(state.x()[0], 0.0);
  integrator.advance(state, 0.5, 1);
  EXPECT_TRUE(std::isnan(state.x()[1]));
}

// Takes some of the shortest steps in a row, as through a collision, between steps of 0.1 s.
class Collisions : public DenseOutputStepper {
 public:
  explicit Collisions(int in_a_row) : in_a_row_(in_a_row) {}
  void start(const State&) override {}
  double step() override { return count_++ % (in_a_row_ + 1) < in_a_row_ ? kShortestStep : 0.1; }
  const StateBuffer& stateAt(double) const override { return state_; }
  StepStatistics statistics() const override { return {}; }

 private:
  int in_a_row_;
  int count_ = 0;
  StateBuffer state_{2};
};

TEST(DenseOutputIntegrator, ShortestStepsAreNoDivergence) {
  for (const double time_step : {0.01, 1.0, 1e3}) {
    DenseOutputIntegrator integrator(dampedChain(), std::make_unique<Collisions>(50));
    State state(2);
    integrator.advance(state, time_step, 2);
    EXPECT_EQ(state.x()[1], 0.0) << time_step;
  }
}

TEST(DenseOutputIntegrator, EndlessShortestStepsAreADivergence) {
  DenseOutputIntegrator integrator(dampedChain(), std::make_unique<Collisions>(1000000));
  State state(2);
  integrator.advance(state, 1.0, 1);
  EXPECT_TRUE(std::isnan(state.x()[1]));
}

}  // namespace
}  // namespace spring_pendulum
