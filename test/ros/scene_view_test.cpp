// The visible part of a scene, for scenes of any size.
#include "ros/markers/scene_view.hpp"

#include <spring_pendulum/io/particle_file.hpp>

#include <gtest/gtest.h>

#include <support/program_run.hpp>

namespace spring_pendulum {
namespace {

Scene horizontal(Eigen::Index particles, double spacing) {
  Scene scene{Eigen::VectorXd::Ones(particles), State(particles)};
  for (Eigen::Index i = 0; i < particles; ++i)
    scene.state.x()[i] = spacing * static_cast<double>(i);
  return scene;
}

bool shows(const SceneView& view, const State& state) {
  const auto low = view.box.min(), high = view.box.max();
  return state.x().minCoeff() >= low.x() && state.x().maxCoeff() <= high.x() &&
         state.y().minCoeff() >= low.y() && state.y().maxCoeff() <= high.y();
}

TEST(SceneView, ShowsTheWholeMotionOfEveryShippedScene) {
  for (const char* name : {"particle", "horizontal_11", "one_spring", "random_masses", "heavy_bob",
                           "two_masses", "hanging_plucked"}) {
    SCOPED_TRACE(name);
    const Scenario scenario;
    test::ProgramRun run(scenario,
                         readParticleFile(std::string(PROJECT_DIR "/data/") + name + ".txt"));
    SceneView view(run, true);
    int widened = 0;
    while (!run.isOver()) {
      run.advance();
      widened += view.widenFor(run.state()) ? 1 : 0;
      ASSERT_TRUE(shows(view, run.state())) << run.time();
    }
    EXPECT_LE(widened, 4);
  }
}

TEST(SceneView, IsFilledByACableBetweenTwoHolders) {
  const test::ProgramRun run(Scenario{}, horizontal(11, 1.0));
  const SceneView view(run, false);
  EXPECT_GT(10.0 / view.box.sizes().x(), 0.85);  // 0.91
}

TEST(SceneView, ScalesWithTheScene) {
  Scenario scenario;
  scenario.constants.gravity = 0.0;
  double last = 0.0;
  for (const double spacing : {1e-3, 1.0, 1e3}) {
    scenario.constants.spring.rest_length = spacing;
    const test::ProgramRun run(scenario, horizontal(11, spacing), {false, 0.0});
    const SceneView view(run, true);
    EXPECT_NEAR(view.cameraDistance(), 20.0 * spacing, 0.1 * spacing);
    EXPECT_NEAR(view.gridDistance(), 2.0 * spacing, 1e-9 * spacing);
    EXPECT_GT(view.textHeight(), last);
    last = view.textHeight();
  }
}

TEST(SceneView, OneParticleHasAPicture) {
  const test::ProgramRun run(Scenario{}, horizontal(1, 1.0), {false, 0.0});
  const SceneView view(run, true);
  EXPECT_NEAR(view.size(), 1.25, 0.75);
}

TEST(SceneView, WidensForAMotionThatLeavesItButNotForEver) {
  const test::ProgramRun run(Scenario{}, horizontal(6, 1.0), {false, 0.0});
  SceneView view(run, true);
  State state = run.start();
  EXPECT_FALSE(view.widenFor(state));
  for (const double x : {30.0, 500.0}) {
    state.x()[5] = x;
    EXPECT_TRUE(view.widenFor(state) && shows(view, state) && !view.widenFor(state));
  }
  state.x()[5] = 1e12;
  EXPECT_FALSE(view.widenFor(state));
  state.x().setLinSpaced(3e5, 3e5 + 5.0);  // carried by robots
  EXPECT_TRUE(view.widenFor(state) && shows(view, state) && view.size() < 20.0);
}

}  // namespace
}  // namespace spring_pendulum
