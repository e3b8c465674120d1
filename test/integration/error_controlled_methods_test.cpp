// Promises of every error-controlled method of the table.
#include "integration/error_control/dense_output_integrator.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/model/energy.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/reference.hpp"
#include "support/scenes.hpp"

namespace spring_pendulum::test {
namespace {

std::vector<Method> errorControlledMethods() {
  std::vector<Method> methods;
  for (const Method& method : methodTable())
    if (!method.hasFixedStep()) methods.push_back(method);
  return methods;
}

std::string testName(const testing::TestParamInfo<Method>& info) {
  std::string name;
  for (const char letter : info.param.name)
    if (std::isalnum(static_cast<unsigned char>(letter)) != 0) name += letter;
  return name;
}

class ErrorControlledMethod : public testing::TestWithParam<Method> {
 protected:
  static std::unique_ptr<Integrator> make(const Scene& scene, double tolerance,
                                          bool track_dissipation = false) {
    return makeIntegrator(GetParam(), scene.chain, {tolerance, track_dissipation});
  }
};

INSTANTIATE_TEST_SUITE_P(Methods, ErrorControlledMethod,
                         testing::ValuesIn(errorControlledMethods()), testName);

constexpr double kTolerances[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};

StepStatistics statisticsOf(const Integrator& integrator) {
  return dynamic_cast<const DenseOutputIntegrator&>(integrator).statistics();
}

/// The largest error at the times, in tolerances.
double worstError(Integrator& integrator, const Scene& scene, const std::string& name,
                  const std::vector<int>& times, double tolerance) {
  State state = scene.start;
  double worst = 0.0;
  int now = 0;
  for (const int time : times) {
    integrator.advance(state, 0.5, std::int64_t{2} * (time - now));
    now = time;
    worst = std::max(worst, positionError(state, referenceSolution(name, time)) / tolerance);
  }
  return worst;
}

// The promise, 10 tolerances, on the cheaper scenes (all: `scripts/benchmark.sh tolerance`). Measured, after
// 50 s of horizontal_11: at most 7.0 (Dormand-Prince-5), 1.3 (Taylor-8), 2.0 (Taylor-12, Auto), 2.9 and 3.5
// (Stabilized-Taylor-4, -8). At 1e-10 m steps must not lose their last bits.
TEST_P(ErrorControlledMethod, KeepsItsTolerance) {
  const std::pair<const char*, std::vector<int>> cases[] = {
      {"single_vertical", {1, 2, 5, 10, 20, 50}},
      {"two_masses_45deg", {1, 2, 5, 10, 20, 50}},
      {"horizontal_11", {1, 2, 5, 10, 20, 50}},
      {"light_100", {1, 5}},
      {"horizontal_1000", {1, 2}},
      {"lighter_100", {1}},  // stability limits explicit methods; measured: at most 0.01
      {"alternating_50", {1}}};
  for (const auto& [name, times] : cases) {
    const Scene scene = referenceScene(name);
    for (const double tolerance : kTolerances) {
      if (times.size() == 1 && tolerance != 1e-4) continue;
      EXPECT_LT(worstError(*make(scene, tolerance), scene, name, times, tolerance), 10.0)
          << name << " at " << tolerance;
    }
  }
}

// A method that ignores the tolerance, and is always accurate, passes the tests above.
TEST_P(ErrorControlledMethod, SpendsLessForLess) {
  const Scene scene = referenceScene("horizontal_11");
  std::int64_t evaluations = 0;
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    const auto integrator = make(scene, tolerance);
    State state = scene.start;
    integrator->advance(state, 1.0, 5);
    EXPECT_GT(integrator->forceEvaluations(), 1.2 * static_cast<double>(evaluations)) << tolerance;
    evaluations = integrator->forceEvaluations();
  }
}

TEST_P(ErrorControlledMethod, GivesTheSameBitsHoweverOftenItIsSampled) {
  const Scene scene = referenceScene("horizontal_11");
  const auto once = make(scene, 1e-5);
  State expected = scene.start;
  once->advance(expected, 0.5, 6);
  for (const int halvings : {1, 3, 6}) {
    const auto often = make(scene, 1e-5);
    State state = scene.start;
    for (int n = 0; n < 6 << halvings; ++n) often->advance(state, 0.5 / (1 << halvings), 1);
    EXPECT_EQ(state.values(), expected.values()) << halvings;
    EXPECT_EQ(statisticsOf(*often).accepted, statisticsOf(*once).accepted) << halvings;
  }
}

// In the end, the spring is no longer than the rounding errors of its place.
TEST_P(ErrorControlledMethod, FollowsACollapse) {
  const Chain chain(Eigen::VectorXd::Ones(2), SpringLaw{50.0, 5.0, 0.0}, 0.0);
  State state(2);
  state.x() << 4.0253285205900777, 5.0253285205900777;
  EXPECT_EQ(makeIntegrator(GetParam(), chain, {1e-6})->advance(state, 0.1, 120), 120);
  EXPECT_NEAR(state.x()[1], state.x()[0], 1e-6);
}

// A chain that stands upright, but for the last digits, falls through itself, and a particle moves up through
// the anchor. The energy shows the error where the forces jump. Afterwards, steps must become longer again.
TEST_P(ErrorControlledMethod, GetsPastCollisions) {
  for (const double sideways : {0.0, 1e-14, 1e-12, 1e-10, 1e-9})
    for (const double tolerance : {1e-9, 1e-12})
      for (const bool thrown : {false, true}) {
        const Chain chain(Eigen::VectorXd::Ones(thrown ? 2 : 5),
                          SpringLaw{thrown ? 50.0 : 38.9, thrown ? 0.0 : 1.0, 1.0}, 9.81);
        State state = straightLine(chain.size(), 0.0, thrown ? -1.0 : 1.0);
        state.x() = sideways * state.y();
        if (thrown) state.vy()[1] = 12.0;
        const double before = computeEnergy(chain, state).total();
        const auto integrator = makeIntegrator(GetParam(), chain, {tolerance, true});
        int crossings = 0;
        for (int n = 0; n < 200; ++n) {
          const double below = state.y()[1];
          integrator->advance(state, 0.01, 1);
          if (below * state.y()[1] < 0.0) ++crossings;
        }
        EXPECT_GT(crossings, thrown ? 1 : 0) << sideways << " " << tolerance;
        const double lost = before - computeEnergy(chain, state).total();
        EXPECT_NEAR(lost, integrator->dissipatedEnergy(), 2e-8)  // Radau-9: 1.9e-8; others: 4e-9
            << sideways << " " << tolerance;
        const int most = GetParam().order < 5 ? 400000 : tolerance < 1e-9 ? 8000 : 2000;
        EXPECT_LT(statisticsOf(*integrator).accepted, most) << sideways << " " << tolerance;
      }
}

// Springs shorter than the rounding errors of their places: in a collapsed chain, far from the origin, and
// where particles meet at rest. Without compensated sums, short steps are lost.
TEST_P(ErrorControlledMethod, GetsPastSpringsOfNoLength) {
  const Chain chain(Eigen::VectorXd::Ones(4), SpringLaw{100.0, 20.0, 0.0}, 0.0);
  State state = straightLine(4, 1.0, 0.0);
  makeIntegrator(GetParam(), chain, {1e-6})->advance(state, 200.0, 1);  // to 1e-160 m
  makeIntegrator(GetParam(), chain.drivenBy({{{3, {1.0, 0.0}}}, {}}), {1e-6})
      ->advance(state, 1.0, 1);
  EXPECT_NEAR(state.x()[1], 0.162222, 1e-5);
  State far(5);
  far.x() = Eigen::VectorXd::LinSpaced(5, 3e5, 300004.0);
  makeIntegrator(GetParam(), Chain(Eigen::VectorXd::Ones(5), SpringLaw{100.0, 0.0, 0.0}, 0.0),
                 {1e-4})
      ->advance(far, 5.0, 1);
  EXPECT_NEAR(far.x()[4], 300000.670869, 1e-3);
  for (double tolerance = 1e-3; tolerance > 1e-9; tolerance /= 2.0) {
    const Chain free(Eigen::Vector3d(1.0, 100.0, 1.0), SpringLaw{300.0, 0.0, 0.5}, 0.0);
    State meeting(3);
    meeting.x()[2] = 1.0;
    const auto integrator = makeIntegrator(GetParam(), free.drivenBy({{{2, {}}}, {}}), {tolerance});
    integrator->advance(meeting, 3.0, 1);
    EXPECT_TRUE(meeting.values().allFinite()) << tolerance;
    EXPECT_LT(integrator->forceEvaluations(), 50000) << tolerance;
  }
  for (const double x : {0.0, 1.0, 1e4})
    for (const double rest_length : {0.0, 1.0})  // all or two start in one place
      for (const double speed : {0.0, 1.0}) {
        State together = straightLine(7, rest_length, 0.0);
        together.values().row(6) = together.values().row(5);
        together.x().array() += x;
        together.vx()[0] = speed;
        const Chain free(Eigen::VectorXd::Ones(7), SpringLaw{50.0, 1.0, rest_length}, 9.81);
        const auto integrator = makeIntegrator(GetParam(), free.drivenBy({{{0, {}}}, {}}), {1e-6});
        integrator->advance(together, 1.0, 1);
        EXPECT_TRUE(together.values().allFinite()) << x << " " << rest_length << " " << speed;
        EXPECT_LT(integrator->forceEvaluations(), 50000) << x << " " << rest_length;
      }
}

TEST_P(ErrorControlledMethod, AddsUpManyEqualSteps) {
  const Chain chain = Chain(Eigen::Vector4d::Constant(5e-3), {}, 9.81).drivenBy({{{0, {}}}, {}});
  State state = equilibrium(chain, State(4));
  state.vx().setConstant(5.0);
  makeIntegrator(GetParam(), chain, {1e-9})->advance(state, 500.0, 1);
  EXPECT_NEAR(state.x()[3], 2500.0, 4e-10);  // measured: 1.5e-10
}

TEST_P(ErrorControlledMethod, TakesLongStepsAtRest) {
  for (const double disturbance : {0.0, 1e-300}) {
    Scene scene{"free", Chain(Eigen::VectorXd::Ones(4), SpringLaw{}, 0.0), State(4)};
    scene.start.x() = Eigen::VectorXd::LinSpaced(4, 0.0, 3.0);
    scene.start.vy()[2] = disturbance;
    const auto integrator = make(scene, 1e-6);
    State state = scene.start;
    integrator->advance(state, 10.0, 10);
    EXPECT_LT(positionError(state, scene.start), 1e-14) << disturbance;  // measured: 4.4e-16
    EXPECT_LT(statisticsOf(*integrator).accepted, 2000) << disturbance;
  }
}

// The energy lost by the chain is the energy dissipated by the dashpots.
TEST_P(ErrorControlledMethod, CountsTheDissipatedEnergyOnlyIfAskedTo) {
  const Scene scene = referenceScene("horizontal_11");
  const auto tracking = make(scene, 1e-6, true), plain = make(scene, 1e-6);
  State tracked = scene.start, state = scene.start;
  for (int frame = 0; frame < 30; ++frame) {
    tracking->advance(tracked, 0.1, 1);
    plain->advance(state, 0.1, 1);
    const double lost = computeEnergy(scene.chain, scene.start).total() -
                        computeEnergy(scene.chain, tracked).total();
    ASSERT_NEAR(tracking->dissipatedEnergy(), lost, 1e-4);  // of 40 J
  }
  EXPECT_GT(tracking->dissipatedEnergy(), 1.0);
  EXPECT_EQ(plain->dissipatedEnergy(), 0.0);
  EXPECT_EQ(tracked.values(), state.values());
  EXPECT_EQ(statisticsOf(*tracking).accepted, statisticsOf(*plain).accepted);
}

}  // namespace
}  // namespace spring_pendulum::test
