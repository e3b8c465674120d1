// A frame in interruptible pieces has the bits of a frame in one piece.
#include "simulation/interruptible.hpp"

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/simulation/frame_steps.hpp>

#include <gtest/gtest.h>

namespace spring_pendulum {
namespace {

State hangingOut(Eigen::Index size) {
  State state(size);
  for (Eigen::Index i = 0; i < size; ++i) state.x()[i] = static_cast<double>(i);
  return state;
}

Scenario scenarioOf(std::string_view method) {
  Scenario scenario;
  scenario.method = findMethod(method);
  scenario.frame_interval = 20.0;  // the first piece is at most 1 s long
  return scenario;
}

class Interruptible : public testing::Test {
 protected:
  State advance(Integrator& integrator, const Scenario& scenario, std::int64_t steps) const {
    State state = start_;
    const FrameSteps frame = frameSteps(scenario);
    for (int i = 0; i < 2; ++i) {
      integrator.advance(state, frame.time_step, frame.steps == 1 ? 1 : steps);
    }
    return state;
  }

  int asked_ = 0;
  State start_ = hangingOut(5);
  Chain chain_{Eigen::VectorXd::Ones(5), SpringLaw{}, 9.81};
};

TEST_F(Interruptible, HasTheSameBitsWithEveryMethod) {
  for (const Method& method : methodTable()) {
    SCOPED_TRACE(method.name);
    const Scenario scenario = scenarioOf(method.name);
    const auto plain = makeIntegrator(method, chain_);
    const auto cut =
        makeInterruptible(scenario, chain_, start_, false, [this] { return ++asked_ < 0; });
    asked_ = 0;
    EXPECT_TRUE(advance(*cut, scenario, 450000).values() ==
                advance(*plain, scenario, 450000).values());
    EXPECT_GE(asked_, 4);  // 2 calls of at least 2 pieces
  }
}

TEST_F(Interruptible, EndsInsideAFrame) {
  for (const Method& method : methodTable()) {
    Scenario scenario = scenarioOf(method.name);
    scenario.steps_per_frame = std::int64_t{1} << 60U;
    scenario.frame_interval = 1e6;
    asked_ = 0;
    const auto cut =
        makeInterruptible(scenario, chain_, start_, false, [this] { return ++asked_ > 3; });
    const FrameSteps frame = frameSteps(scenario);
    State state = start_;
    EXPECT_THROW(cut->advance(state, frame.time_step, frame.steps), Interrupted) << method.name;
  }
}

}  // namespace
}  // namespace spring_pendulum
