// Wrong use of every public function ends in an InputError, also in a release build.
#include "simulation/judge.hpp"
#include <spring_pendulum/spring_pendulum.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace spring_pendulum {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::ptrdiff_t kSize = 5;
constexpr std::ptrdiff_t kWrongSizes[] = {0, 1, kSize - 1, kSize + 1, 1000};

Chain chain() {
  return {Eigen::VectorXd::Ones(kSize), SpringLaw{}, 9.81};
}

State horizontal() {
  State state(kSize);
  state.x() = Eigen::VectorXd::LinSpaced(kSize, 0.0, 4.0);
  return state;
}

TEST(Misuse, NegativeSizesAndStatesOfAnotherSize) {
  EXPECT_THROW(AlignedNumbers(-1), std::length_error);
  EXPECT_THROW(State(-1), InputError);
  EXPECT_THROW(State{std::numeric_limits<std::ptrdiff_t>::min()}, InputError);
  for (const std::ptrdiff_t size : kWrongSizes) {
    State slope;
    EXPECT_THROW(springForceOn(chain(), State(size), 0), InputError) << size;
    EXPECT_THROW(computeSlope(chain(), State(size), slope), InputError) << size;
    EXPECT_THROW(computeEnergy(chain(), State(size)), InputError) << size;
    EXPECT_THROW(dissipatedPower(chain(), State(size)), InputError) << size;
  }
}

TEST(Misuse, RunsFromStatesOfAnotherSizeAndTimes) {
  ReferenceRun reference(chain(), horizontal());
  for (const std::ptrdiff_t size : kWrongSizes) {
    const State wrong(size);
    EXPECT_THROW(chainLength(chain(), wrong), InputError) << size;
    EXPECT_THROW(ReferenceRun(chain(), wrong), InputError) << size;
    EXPECT_THROW(static_cast<void>(reference.errorOf(wrong)), InputError) << size;
    EXPECT_THROW(Judge(chain(), wrong, JudgeOptions{true}), InputError) << size;
    EXPECT_THROW(checkStability(chain(), wrong, Scenario{}), InputError) << size;
    EXPECT_THROW(largestStableStep(chain(), wrong, Scenario{}), InputError) << size;
  }
  EXPECT_THROW(checkStability(chain().drivenBy({{{1, {5, 0}}}, {}}), horizontal(), {}), InputError);
  EXPECT_THROW(reference.advance(kNan, 1), InputError);
  EXPECT_THROW(reference.advance(0.1, -1), InputError);
  for (const double time : {0.0, -1.0, kNan, kInfinity})
    EXPECT_THROW(linearStepLimit(findMethod("Euler"), chain(), time), InputError);
}

TEST(Misuse, SpringsThatDoNotExistAndSlopeAndStateInOnePlace) {
  EXPECT_THROW(springForceOn(chain(), horizontal(), -1), InputError);
  EXPECT_THROW(springForceOn(chain(), horizontal(), kSize - 1), InputError);
  EXPECT_NO_THROW(springForceOn(chain(), horizontal(), kSize - 2));
  State state = horizontal();
  EXPECT_THROW(computeSlope(chain(), state, state), InputError);
}

TEST(Misuse, OptionsOfIntegrators) {
  for (const Method& method : methodTable()) {
    for (const double tolerance : {0.0, -1.0, kNan, kInfinity}) {
      if (method.hasFixedStep()) continue;  // reads no tolerance
      EXPECT_THROW(makeIntegrator(method, chain(), {tolerance}), InputError) << method.name;
    }
    EXPECT_THROW(makeIntegrator(method, chain(), {1e-6, false, -1}), InputError);
  }
  EXPECT_THROW(makeIntegrator("", chain()), InputError);
  Chain source = chain();
  const Chain moved = std::move(source);
  EXPECT_THROW(makeIntegrator("Euler", source), InputError);  // NOLINT(bugprone-use-after-move)
}

TEST(Misuse, ArgumentsOfAdvance) {
  for (const Method& method : methodTable()) {
    SCOPED_TRACE(method.name);
    const auto integrator = makeIntegrator(method, chain());
    for (const bool running : {false, true}) {
      for (const std::ptrdiff_t size : kWrongSizes) {
        State wrong(size);
        EXPECT_THROW(integrator->advance(wrong, 0.01, 1), InputError) << running;
      }
      State state = horizontal();
      for (const double step : {0.0, -0.01, kNan, kInfinity, -kInfinity})
        EXPECT_THROW(integrator->advance(state, step, 1), InputError) << step;
      EXPECT_THROW(integrator->advance(state, 0.01, -1), InputError);
      EXPECT_THROW(integrator->advance(state, 0.01, std::numeric_limits<std::int64_t>::min()),
                   InputError);
      EXPECT_EQ(state.values(), horizontal().values());  // nothing was touched
      integrator->advance(state, 0.01, 0);
      integrator->advance(state, 0.01, 3);
    }
  }
}

// The starting state may hold anything: the result is not finite, but every run ends, and none crashes.
TEST(Misuse, StatesThatAreNotFinite) {
  for (const Method& method : methodTable())
    for (const double value : {kNan, kInfinity, 1e308}) {
      State state = horizontal();
      state.x()[2] = value;
      makeIntegrator(method, chain())->advance(state, 0.01, 3);
      EXPECT_FALSE(state.values().allFinite() && value != 1e308) << method.name << " " << value;
    }
}

template <typename Action>
std::string messageOf(const Action& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Misuse, StartsOfRuns) {
  const auto start = [](const State& state, double interval) {
    spring_pendulum::Run({chain().masses(), state}, Plan{}, {false, interval});
  };
  for (const double s : {kNan, -1.0})
    EXPECT_EQ(messageOf([&] { start(horizontal(), s); }), "display_interval must be at least 0 s");
  Scenario dear;  // too many frames for tracking the dissipated energy by default
  dear.frames = 1000000;
  dear.energy = "never written";
  State wrong = horizontal();
  wrong.vx()[0] = 1.0;
  spring_pendulum::Run run({chain().masses(), wrong}, dear);
  EXPECT_EQ(messageOf([&] { RunFiles(run, dear); }),
            "energy: the run must have RunOptions::track_dissipation");
  EXPECT_EQ(messageOf([&] { run.goTo(-1, horizontal()); }), "frame: must be at least 0, got -1");
  run.change(dear, chain().constants(), {{}, {{2, {0.5, 0.0}}}}, wrong);
  EXPECT_TRUE(run.advance() && run.advance() && run.state().x()[0] > 0.09);  // P_1 keeps moving
  run.reset();
  EXPECT_EQ(run.state().values(), horizontal().values());  // P_1 of a scene is fixed
  for (const double value : {kNan, kInfinity}) {
    wrong.vy()[2] = value;
    const std::string expected = "particle 3: position and velocity must be finite";
    EXPECT_EQ(messageOf([&] { run.goTo(0, wrong); }), expected);
    EXPECT_EQ(messageOf([&] { start(wrong, 0.0); }), expected);
  }
}

/// A method of a program that does all it must not.
class Wrong final : public Integrator {
 public:
  void integrate(State& state, double, std::int64_t) override {
    state = State(state.size() + 1);
    state.values().setConstant(kNan);
  }
  void restart() override {}
  double work() const override { return kNan; }
  std::int64_t forceEvaluations() const override { return -1; }
  double dissipatedEnergy() const override { return kNan; }
};

TEST(Misuse, MethodsOfPrograms) {
  Method method;
  method.name = "Wrong";
  method.order = 1;
  method.stages = 1;
  method.make = [](const Method&, const Chain& chain, const IntegratorOptions&) {
    if (chain.isDriven()) throw InputError("Wrong drives no particles");
    return std::make_unique<Wrong>();
  };
  Method worse = method;
  worse.bytes_per_particle = kNan;
  EXPECT_THROW(registerMethod(worse), InputError);
  registerMethod(method);
  EXPECT_THROW(registerMethod(method), InputError);
  Scenario scenario;
  scenario.method = findMethod("Wrong");
  spring_pendulum::Run run({chain().masses(), horizontal()}, scenario, {true});
  EXPECT_THROW(run.change(scenario, {}, {{{4, {}}}, {}}, horizontal()), InputError);
  EXPECT_FALSE(run.isChanged() || run.chain().isDriven());
  EXPECT_TRUE(run.advance());
  EXPECT_THROW(run.advance(), InputError);
}

}  // namespace
}  // namespace spring_pendulum
