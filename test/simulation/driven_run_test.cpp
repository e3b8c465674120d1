// Held particles, applied forces, changes of a run and air drag, against solutions with 113 bits.
#include "model/chain_modes.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/energy.hpp>
#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/precise_motion.hpp"
#include "support/scenes.hpp"

namespace spring_pendulum::test {
namespace {

constexpr double kInterval = 0.02;  // s between two inputs: 50 Hz

/// Acceleration of a hand that moves about, in the input interval k.
PlaneVector<double> handAcceleration(int k, double phase) {
  const double t = kInterval * k;
  return {0.4 * std::sin(2.1 * t + phase) + 3.0 * std::cos(5.3 * t),
          0.9 * std::cos(3.7 * t - phase) - 2.0 * std::sin(6.1 * t + phase)};
}

Scene slackCable(Eigen::Index particles, double mass, double air_drag = 0.0) {
  Scene scene = horizontalChain("slack cable", particles, mass);
  scene.chain = inAir(scene.chain, air_drag);
  scene.start.x() *= 0.8;
  return scene;
}

Scenario scenarioOf(const std::string& method, const Scene& scene) {
  Scenario scenario;
  scenario.method = findMethod(method);
  scenario.constants = scene.chain.constants();
  scenario.frames = 1000000;
  scenario.steps_per_frame = 2;
  scenario.time_step = 0.5 * kInterval;
  scenario.frame_interval = kInterval;
  return scenario;
}

/// A run and the precise motion, both driven in the same way.
struct DrivenPair {
  DrivenPair(const Scenario& scenario, const Scene& scene)
      : run(makeScene(scenario, {scene.chain.masses(), scene.start}), scenario, {true, 0.0, {}}),
        precise(scene) {
    run.advance();
  }

  void drive(const Drive& drive) {
    run.change(run.plan(), run.chain().constants(), drive, run.state());
    precise.drive(run.chain());
  }

  void advance() {
    run.advance();
    precise.advance(kInterval);
  }

  double error() const { return precise.errorOf(run.state()); }

  Run run;
  PreciseMotion precise;
};

/// Drives both ends of a cable, and a particle inside in between, like three hands.
void moveHands(DrivenPair& pair, int inputs) {
  const std::ptrdiff_t last = pair.run.chain().size() - 1;
  for (int k = 0; k < inputs; ++k) {
    Drive drive{{{0, handAcceleration(k, 0.0)}, {last, handAcceleration(k, 2.0)}}, {}};
    if (k >= 20 && k < 60) drive.held.push_back({last / 3, handAcceleration(k, 4.0)});
    if (k >= 40 && k < 50) drive.forces.push_back({last / 2, {3.0, -5.0}});
    pair.drive(drive);
    pair.advance();
  }
}

std::vector<std::string> errorControlled() {
  std::vector<std::string> names;
  for (const Method& method : methodTable())
    if (!method.hasFixedStep()) names.push_back(method.name);
  return names;
}

class DrivenErrorControlled : public testing::TestWithParam<std::string> {};

TEST_P(DrivenErrorControlled, KeepsTheTolerance) {
  for (const auto& [tolerance, air_drag] : {std::pair{1e-5, 0.3}, {1e-6, 0.0}, {1e-9, 0.0}}) {
    const Scene scene = slackCable(7, 1.0, air_drag);
    Scenario scenario = scenarioOf(GetParam(), scene);
    scenario.tolerance = tolerance;
    DrivenPair pair(scenario, scene);
    moveHands(pair, 150);
    EXPECT_LE(pair.error(), 10.0 * tolerance) << tolerance;
    const EnergyEntry entry = pair.run.energyEntry();
    EXPECT_GT(std::abs(entry.supplied), 1.0);
    EXPECT_LE(std::abs(entry.relative_residual.value()), tolerance);
    EXPECT_EQ(pair.run.verdict().kind, VerdictKind::kNotChecked) << pair.run.verdict().text;
  }
}

INSTANTIATE_TEST_SUITE_P(AllMethods, DrivenErrorControlled, testing::ValuesIn(errorControlled()));

TEST(DrivenRun, CountsTheWorkOfAKickByEulersMethods) {
  for (const char* method : {"Euler", "Backward-Euler"}) {
    const Scene scene = horizontalChain("kicked", 3, 1.0, {50.0, 1.0, 1.0}, 0.0);
    DrivenPair pair(scenarioOf(method, scene), scene);
    pair.drive({{}, {{2, {10.0, 0.0}}}});
    pair.advance();
    pair.drive({});
    pair.advance();
    EXPECT_LE(std::abs(pair.run.energyEntry().relative_residual.value()), 0.1) << method;
  }
}

// Lifted with an acceleration a, a particle that starts with the velocity `offset` · h a keeps its distance
// from its holder: their force is constant, and the trapezoidal rule for their work is exact.
TEST(DrivenRun, TakesThePowerOfAHolderAtItsPlace) {
  const double h = 0.1, a = 2.0, force = 9.81 + a;
  for (const auto& [method, offset] : {std::pair{"Euler", 0.5},
                                       {"Semi-Implicit-Euler", -0.5},
                                       {"Backward-Euler", -0.5},
                                       {"Velocity-Verlet", 0.0}}) {
    const Scene scene = horizontalChain("lifted", 2, 1.0, {50.0, 0.0, 1.0});
    State state(2);
    state.values().row(1) << 0.0, -1.0 - force / 50.0, 0.0, offset * h * a;
    const auto lifted =
        makeIntegrator(findMethod(method), scene.chain.drivenBy({{{0, {0.0, a}}}, {}}));
    lifted->advance(state, h, 10);
    EXPECT_NEAR(lifted->suppliedEnergy(), force * 0.5 * a, 1e-12) << method;
  }
}

TEST(DrivenRun, FollowsLightParticlesWithAuto) {
  for (const double air_drag : {0.0, 0.02}) {
    const Scene scene = slackCable(5, 1e-3, air_drag);
    Scenario scenario = scenarioOf("Auto", scene);
    DrivenPair pair(scenario, scene);
    moveHands(pair, 25);
    EXPECT_LE(pair.error(), 10.0 * scenario.tolerance) << air_drag;
    EXPECT_LE(std::abs(pair.run.energyEntry().relative_residual.value()), 1e-6) << air_drag;
    const Scene lighter = slackCable(3, 1e-6, air_drag);  // its velocities do not tell the tensions
    DrivenPair light(scenario, lighter);
    light.drive({{{0, {1.0, 0.0}}}, {}});
    while (light.run.time() < 1.0) light.run.advance();
    EXPECT_LE(std::abs(light.run.energyEntry().relative_residual.value()), 1e-4) << air_drag;
  }
}

double errorOf(const Scene& scene, const Method& method, std::int64_t steps, double& residual) {
  Scenario scenario = scenarioOf(method.name, scene);
  scenario.steps_per_frame = steps;
  scenario.time_step = kInterval / static_cast<double>(steps);
  DrivenPair pair(scenario, scene);
  moveHands(pair, 100);
  residual = std::abs(pair.run.energyEntry().relative_residual.value());
  return pair.error();
}

TEST(DrivenRun, HasTheOrderOfItsMethod) {
  for (const Method& method : methodTable()) {
    if (!method.hasFixedStep()) continue;
    for (const double air_drag : {0.0, 0.3}) {
      SCOPED_TRACE(method.name + " " + std::to_string(air_drag));
      const Scene scene = slackCable(7, 1.0, air_drag);
      const std::int64_t steps = method.order == 1 ? 64 : method.order == 2 ? 4 : 2;
      double residual = 0.0, half_residual = 0.0;
      const double error = errorOf(scene, method, steps, residual);
      const double half = errorOf(scene, method, 2 * steps, half_residual);
      EXPECT_NEAR(std::log2(error / half), method.order, 0.25) << error;
      EXPECT_GT(std::log2(residual / half_residual), method.order - 0.75) << residual;
      EXPECT_LE(half_residual, method.order == 1 ? 1e-2 : 1e-3);
      EXPECT_GT(half_residual, 0.0);
    }
  }
}

TEST(DrivenRun, IsTheSameInOneCallOrInMany) {
  const Scene scene = slackCable(7, 1.0);
  const Drive drive{{{0, {0.3, -0.2}}, {4, {0.1, 0.5}}}, {{2, {1.0, 0.0}}}};
  const Chain chain = scene.chain.drivenBy({{{2, {}}}, {}}).drivenBy(drive);  // lets P_3 go again
  for (const Method& method : methodTable()) {
    State one = scene.start, many = scene.start;
    one.vx()[4] = many.vx()[4] = 0.7;
    one.vy()[0] = many.vy()[0] = -0.4;
    const auto a = makeIntegrator(method, chain);
    const auto b = makeIntegrator(method, scene.chain.drivenBy(drive));
    a->advance(one, 0.01, 50);
    for (int i = 0; i < 10; ++i) b->advance(many, 0.01, 5);
    EXPECT_EQ(one.values(), many.values()) << method.name;
    EXPECT_EQ(a->suppliedEnergy(), b->suppliedEnergy()) << method.name;
    // The prescribed motion is exact for every method.
    EXPECT_NEAR(one.x()[4], scene.start.x()[4] + 0.7 * 0.5 + 0.0125, 1e-15) << method.name;
    EXPECT_NEAR(one.y()[0], -0.4 * 0.5 - 0.5 * 0.2 * 0.25, 1e-15) << method.name;
    EXPECT_NEAR(one.vy()[0], -0.4 - 0.2 * 0.5, 1e-15) << method.name;
  }
}

TEST(DrivenRun, HangsFromAHeldParticleAsFromAnAnchor) {
  const Scene scene = slackCable(7, 1.0);
  Scene part{"part", Chain(Eigen::VectorXd::Ones(4), scene.chain.spring(), 9.81), State(4)};
  part.start.values() = scene.start.values().bottomRows(4);
  for (const char* method : {"Runge-Kutta-4", "Taylor-12", "Radau-9"}) {
    State whole = scene.start, free = part.start;
    makeIntegrator(method, scene.chain.drivenBy({{{3, {}}}, {}}))->advance(whole, 0.01, 200);
    makeIntegrator(method, part.chain)->advance(free, 0.01, 200);
    EXPECT_LE((whole.values().bottomRows(4) - free.values()).cwiseAbs().maxCoeff(), 1e-6) << method;
    EXPECT_EQ(whole.x()[3], scene.start.x()[3]);
  }
}

TEST(DrivenRun, KeepsTheVelocityOfAReleasedParticle) {
  const Scene scene = slackCable(5, 1.0);
  DrivenPair pair(scenarioOf("Auto", scene), scene);
  pair.drive({{{4, {2.0, 1.0}}}, {}});
  for (int k = 0; k < 25; ++k) pair.advance();
  const State held = pair.run.state();
  EXPECT_NEAR(held.vx()[4], 2.0 * 0.5, 1e-14);
  pair.drive({});
  EXPECT_EQ(pair.run.state().values(), held.values());
  for (int k = 0; k < 25; ++k) pair.advance();
  EXPECT_LE(pair.error(), 1e-5);
  EXPECT_LE(std::abs(pair.run.energyEntry().relative_residual.value()), 1e-6);
}

// No free particle limits the step with which the work of the holder would be summed.
TEST(DrivenRun, LeavesOutSpringsBetweenHeldParticles) {
  const Scene scene = horizontalChain("pair", 2, 1.0);
  for (const Method& method : methodTable()) {
    DrivenPair pair(scenarioOf(method.name, scene), scene);
    State passing = scene.start;
    passing.values().row(1).tail(3) << 0.001, -1.0, 0.0;
    pair.run.change(pair.run.plan(), pair.run.chain().constants(), {{{1, {}}}, {}}, passing);
    const double before = pair.run.energyEntry().supplied;
    while (pair.run.time() < 2.0) pair.run.advance();
    EXPECT_EQ(pair.run.energyEntry().supplied, before) << method.name;
    EXPECT_NEAR(pair.run.energyEntry().relative_residual.value(), 0.0, 1e-12) << method.name;
    EXPECT_EQ(dissipatedPower(pair.run.chain(), pair.run.state()), 0.0);
  }
}

TEST(DrivenRun, AccountsForJumpsOfConstantsMethodsAndStates) {
  const Scene scene = horizontalChain("horizontal", 6, 1.0);
  Scenario undamped = scenarioOf("Auto", scene);
  undamped.constants.spring.damping = 0.0;
  DrivenPair pair(undamped, scene);
  pair.run.goTo(1, pair.run.state());
  const auto go_on = [&] {
    for (int k = 0; k < 30; ++k) pair.run.advance();
    EXPECT_LE(std::abs(pair.run.energyEntry().relative_residual.value()), 1e-6);
    EXPECT_FALSE(isBad(pair.run.verdict().kind)) << pair.run.verdict().text;
  };
  Scenario scenario{pair.run.plan(), pair.run.chain().constants()};
  EXPECT_NE(pair.run.closingLine().find("switches"), std::string::npos);
  for (const double factor : {0.0, 3.0}) {
    go_on();
    scenario.constants.spring.damping = factor;
    scenario.constants.gravity = -9.81 * factor;
    scenario.constants.spring.stiffness = 200.0;
    pair.run.change(scenario, scenario.constants, {}, pair.run.state());
  }
  go_on();
  // The new integrator knows the methods since the last change only.
  EXPECT_EQ(pair.run.closingLine().find("switches"), std::string::npos);
  State state = pair.run.state();
  state.vx()[5] += 3.0;
  scenario.method = findMethod("Runge-Kutta-4");
  scenario.constants.spring.rest_length = 0.5;
  const double time = pair.run.time();
  pair.run.change(scenario, scenario.constants, {}, state);
  EXPECT_NEAR(pair.run.energyEntry().energy.kinetic, 0.5 * state.velocities().squaredNorm(), 1e-9);
  pair.run.advance();
  EXPECT_NEAR(pair.run.time(), time + kInterval, 1e-12);
  EXPECT_NE(pair.run.closingLine().find(" 2 steps, "), std::string::npos);
}

// So a saved state has the time of its frame, whatever methods have computed it.
TEST(DrivenRun, KeepsTheIntervalOfItsFrames) {
  const Scene scene = horizontalChain("horizontal", 3, 1.0);
  Scenario scenario = scenarioOf("Runge-Kutta-4", scene);
  scenario.time_step = 0.007;
  scenario.steps_per_frame = 10;
  DrivenPair pair(scenario, scene);
  for (const char* method : {"Auto", "Velocity-Verlet", "Taylor-8", "Euler"}) {
    scenario.method = findMethod(method);
    pair.run.change(scenario, scenario.constants, {}, pair.run.state());
    pair.run.advance();
    pair.run.advance();
    EXPECT_NEAR(pair.run.time(), 0.07 * static_cast<double>(pair.run.frame()), 1e-14) << method;
  }
  for (const double wanted : {0.01, 0.03}) {
    Scenario other = scenarioOf("Auto", scene);
    other.frame_interval = 0.07;
    other.time_step = wanted;
    DrivenPair changed(other, scene);
    other.method = findMethod("Euler");
    changed.run.change(other, other.constants, {}, changed.run.state());
    EXPECT_EQ(changed.run.plan().time_step, 0.07 / (wanted == 0.01 ? 7 : 3));
  }
}

TEST(DrivenRun, ReturnsToAMeasuredStart) {
  const Scene scene = horizontalChain("horizontal", 4, 1.0);
  DrivenPair pair(scenarioOf("Auto", scene), scene);
  pair.drive({{{3, {1.0, 1.0}}}, {}});
  pair.advance();
  EXPECT_EQ(pair.run.verdict().kind, VerdictKind::kNotChecked);
  pair.run.change(pair.run.plan(), pair.run.chain().constants(), {}, pair.run.start());
  pair.run.goTo(0, pair.run.start());
  EXPECT_FALSE(pair.run.isChanged());
  EXPECT_EQ(pair.run.time(), 0.0);
  for (int k = 0; k < 10; ++k) pair.run.advance();
  EXPECT_EQ(pair.run.verdict().kind, VerdictKind::kOk) << pair.run.verdict().text;
  EXPECT_EQ(pair.run.energyEntry().supplied, 0.0);
}

TEST(DrivenRun, RefusesWhatAChainCannotDo) {
  const Scene scene = slackCable(4, 1.0);
  const double nan = std::nan("");
  EXPECT_THROW(scene.chain.drivenBy({{{4, {}}}, {}}), InputError);
  EXPECT_THROW(scene.chain.drivenBy({{{-1, {}}}, {}}), InputError);
  EXPECT_THROW(scene.chain.drivenBy({{{1, {}}, {1, {}}}, {}}), InputError);
  EXPECT_THROW(scene.chain.drivenBy({{{1, {nan, 0.0}}}, {}}), InputError);
  EXPECT_THROW(scene.chain.drivenBy({{}, {{0, {1.0, 0.0}}}}), InputError);
  EXPECT_THROW(scene.chain.drivenBy({{}, {{9, {1.0, 0.0}}}}), InputError);
  EXPECT_THROW(scene.chain.drivenBy({{}, {{2, {0.0, nan}}}}), InputError);
  DrivenPair pair(scenarioOf("Auto", scene), scene);
  State state = scene.start;
  state.x()[2] = nan;
  EXPECT_THROW(pair.run.change(pair.run.plan(), scene.chain.constants(), {}, state), InputError);
  EXPECT_THROW(pair.run.change(pair.run.plan(), scene.chain.constants(), {}, State(3)), InputError);
  Scenario scenario{pair.run.plan(), pair.run.chain().constants()};
  scenario.constants.spring.stiffness = -1.0;
  EXPECT_THROW(pair.run.change(scenario, scenario.constants, {}, scene.start), InputError);
  EXPECT_EQ(pair.run.chain().spring().stiffness, scene.chain.spring().stiffness);
}

TEST(AirDrag, KeepsTheTolerance) {
  // Light particles: the air damps them with 50/s, and strongly: with 2000/s.
  for (const auto& [mass, damping, air_drag] :
       {std::tuple{1.0, 1.0, 0.5}, {1.0, 0.0, 0.2}, {1e-3, 1.0, 0.05}, {1e-3, 0.1, 2.0}}) {
    Scene scene = horizontalChain("in air", 7, mass, {50.0, damping, 1.0});
    scene.chain = inAir(scene.chain, air_drag);
    PreciseMotion precise(scene);
    for (int frame = 0; frame < 60; ++frame) precise.advance(kInterval);
    for (const std::string& method : errorControlled()) {
      SCOPED_TRACE(method + " " + std::to_string(mass) + " " + std::to_string(air_drag));
      for (const double tolerance : {1e-5, 1e-8}) {
        Scenario scenario = scenarioOf(method, scene);
        scenario.frames = 61;
        scenario.tolerance = tolerance;
        spring_pendulum::Run run(makeScene(scenario, {scene.chain.masses(), scene.start}), scenario,
                                 {true});
        while (run.advance()) continue;
        EXPECT_FALSE(isBad(run.verdict().kind)) << run.verdict().text;
        EXPECT_LE(precise.errorOf(run.state()), 10.0 * tolerance);
        EXPECT_GT(precise.errorOf(run.state()), 0.0);
        EXPECT_LE(std::abs(run.energyEntry().relative_residual.value()),
                  std::max(10.0 * tolerance, 1e-6));
      }
    }
  }
}

TEST(AirDrag, LimitsTheSpeedOfAFall) {
  const double mass = 0.5, drag = 0.7, time = 2.0;
  const Chain chain(Eigen::VectorXd::Constant(2, mass), {{0.0, 0.0, 1.0}, 9.81, drag});
  const double speed = 9.81 * mass / drag * (1.0 - std::exp(-drag / mass * time));
  for (const Method& method : methodTable()) {
    State state = straightLine(2, 1.0, 0.0);
    makeIntegrator(method, chain, {1e-9})->advance(state, 1e-3, 2000);
    EXPECT_NEAR(state.vy()[1], -speed, method.order == 1 ? 1e-2 : 1e-5) << method.name;
  }
}

TEST(AirDrag, EntersPowerAndRates) {
  const double drag = 0.6;
  const Chain chain(Eigen::VectorXd::Constant(3, 2.0), {{0.0, 0.0, 1.0}, 9.81, drag});
  State state = straightLine(3, 1.0, 0.0);
  state.vx()[1] = 3.0;
  state.vy()[2] = 4.0;
  EXPECT_DOUBLE_EQ(dissipatedPower(chain, state), drag * 25.0);
  EXPECT_DOUBLE_EQ(dissipatedPower(chain.drivenBy({{{2, {}}}, {}}), state), drag * 9.0);
  EXPECT_DOUBLE_EQ(largestDampingRate(chain), drag / 2.0);
}

}  // namespace
}  // namespace spring_pendulum::test
