#include "integration/error_control/error_controlled.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace spring_pendulum {
namespace {

// A motion known at all times, x(t) = t + s of the start, in steps of 0.3 s; it diverges after a
// number of steps and heats with 2 W.
class UniformMotion : public AdaptiveStepper {
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
  void interpolate(double fraction, State& state) const override {
    state.x()[1] = begin_ + fraction * kLength;
  }
  double dissipated(double fraction) const override { return 2.0 * fraction * kLength; }
  StepStatistics statistics() const override { return statistics_; }

 private:
  static constexpr double kLength = 0.3;
  int left_;
  double begin_ = 0.0;
  double end_ = 0.0;
  StepStatistics statistics_;
};

TEST(ErrorControlled, ReadsTheOutputTimesOutOfItsOwnSteps) {
  ErrorControlled integrator(std::make_unique<UniformMotion>());
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

TEST(ErrorControlled, GoesOnFromTheLastOutputTimeWithAnotherTimeStep) {
  ErrorControlled integrator(std::make_unique<UniformMotion>());
  State state(2);
  integrator.advance(state, 0.25, 3);
  integrator.advance(state, 0.1, 2);
  EXPECT_NEAR(state.x()[1], 0.95, 1e-14);
}

TEST(ErrorControlled, RestartsFromANewState) {
  ErrorControlled integrator(std::make_unique<UniformMotion>());
  State state(2);
  integrator.advance(state, 0.25, 3);
  integrator.restart();
  EXPECT_EQ(integrator.dissipatedEnergy(), 0.0);
  state.x()[1] = -1.0;
  integrator.advance(state, 0.25, 3);
  EXPECT_NEAR(state.x()[1], -0.25, 1e-14);
  EXPECT_NEAR(integrator.dissipatedEnergy(), 1.5, 1e-14);
}

TEST(ErrorControlled, ShowsADivergedMotionInTheStateFromThenOn) {
  ErrorControlled integrator(std::make_unique<UniformMotion>(2));
  State state(2);
  integrator.advance(state, 0.5, 1);
  EXPECT_NEAR(state.x()[1], 0.5, 1e-14);
  integrator.advance(state, 0.5, 1);
  EXPECT_TRUE(std::isnan(state.x()[1]));
  EXPECT_EQ(state.x()[0], 0.0);
  integrator.advance(state, 0.5, 1);
  EXPECT_TRUE(std::isnan(state.x()[1]));
}

}  // namespace
}  // namespace spring_pendulum
