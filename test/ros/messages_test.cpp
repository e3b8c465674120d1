// Markers and state of chosen scenes, bags through the rosbag library, parameters.
#include "ros/messages/run_messages.hpp"
#include "ros/parameters/node_options.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <tuple>

#include <support/program_run.hpp>

namespace spring_pendulum {
namespace {

Scene horizontal(Eigen::Index particles) {
  Scene scene{Eigen::VectorXd::Ones(particles), State(particles)};
  for (Eigen::Index i = 0; i < particles; ++i) scene.state.x()[i] = static_cast<double>(i);
  return scene;
}

/// Older releases of ROS generate messages without operator==.
std::array<float, 4> rgba(const std_msgs::ColorRGBA& color) {
  return {color.r, color.g, color.b, color.a};
}

visualization_msgs::MarkerArray markersOf(const Run& run, const NodeOptions& options) {
  RunMessages messages(run, options, true);
  return *messages.build(run, {})->markers;
}

TEST(Markers, LongChainsAreThinnedAndKeepBothEnds) {
  for (const Eigen::Index particles : {2, 3, 9, 10, 11, 12, 100, 101}) {
    const test::ProgramRun run(Scenario{}, horizontal(particles), {false, 0.0});
    NodeOptions options;
    options.display_limit = 10;
    const auto markers = markersOf(run, options).markers;
    const auto& points = markers[1].points;
    ASSERT_LE(points.size(), 10U) << particles;
    EXPECT_EQ(points.front().x, 0.0);
    EXPECT_EQ(points.back().x, static_cast<double>(particles - 1));
    EXPECT_EQ(points.size(), markers[1].colors.size());
    EXPECT_EQ(markers[0].points.size(), 2 * (points.size() - 1));
    EXPECT_EQ(markers[0].colors.size(), markers[0].points.size());
    EXPECT_EQ(particles > 10, markers[3].text.find("particles drawn") != std::string::npos);
  }
}

TEST(Markers, GridHasFewLinesFarFromTheOriginAndAtExtremeLengths) {
  Scenario scenario;
  scenario.constants.spring = {0.0, 0.0, 0.0};
  scenario.constants.gravity = 0.0;
  for (const auto& [left, length] : {std::pair{0.0, 16.0},
                                     {1e17, 100.0},
                                     {-1e17, 16.0},
                                     {1e100, 1e85},
                                     {0.0, 5e-324},
                                     {0.0, 1e-300},
                                     {0.0, 1e100},
                                     {0.0, 1e150}}) {
    Scene scene = horizontal(2);
    scene.state.x() << left, left + length;
    const test::ProgramRun run(scenario, scene, {false, 0.0});
    const auto grid = markersOf(run, NodeOptions{}).markers[4].points;
    EXPECT_LT(grid.size(), 400U) << left << " " << length;
    EXPECT_TRUE(length < 1.0 || length > 1e85 || grid.size() > 40U) << left;
  }
}

TEST(Markers, ADivergedChainIsMagentaAndKeepsItsLastShape) {
  Scenario scenario;
  scenario.method = findMethod("Euler");
  scenario.constants.spring.damping = 0.0;
  scenario.time_step = 0.5;
  test::ProgramRun run(scenario, horizontal(3), {false, 0.0});
  NodeOptions options;
  options.color = "#ff8000";
  RunMessages messages(run, options, true);
  const auto before = messages.build(run, {})->markers->markers[0];
  while (!run.isOver()) run.advance();
  ASSERT_EQ(run.verdict().kind, VerdictKind::kDiverged);
  const auto springs = messages.build(run, {})->markers->markers[0];
  ASSERT_EQ(springs.points.size(), before.points.size());
  EXPECT_EQ(springs.points[1].x, before.points[1].x);
  ASSERT_EQ(springs.colors.size(), 4U);
  for (const auto& color : springs.colors) EXPECT_EQ(rgba(color), rgba(colorOf(kDivergedColor)));
}

TEST(Markers, LinesOfTextAreOverEachOtherInTheFrameOfTheCamera) {
  const test::ProgramRun run(Scenario{}, horizontal(3), {false, 0.0});
  NodeOptions options;
  options.text_row = 1;
  const auto lower = markersOf(run, options).markers[3];
  options.text_row = 2;
  const auto upper = markersOf(run, options).markers[3];
  EXPECT_EQ(lower.header.frame_id, options.camera_frame);
  EXPECT_EQ(lower.pose.position.y, 0.0);
  EXPECT_GT(upper.pose.position.z, lower.pose.position.z + lower.scale.z);
}

TEST(Markers, HeldParticlesHaveTheColourOfTheAnchor) {
  spring_pendulum::Run run(horizontal(3), Plan{}, {false, 0.0});
  run.change(Plan{}, Constants{}, Drive{{{2, {}}}, {}}, run.state());
  const auto particles = markersOf(run, NodeOptions{}).markers[1];
  EXPECT_NE(rgba(particles.colors[1]), rgba(colorOf(kHeldColor)));
  EXPECT_EQ(rgba(particles.colors[2]), rgba(colorOf(kHeldColor)));
}

TEST(Markers, OnlyTheFirstChainHasACamera) {
  const test::ProgramRun run(Scenario{}, horizontal(3), {false, 0.0});
  for (const int row : {0, 1, 2}) {
    NodeOptions options;
    options.text_row = row;
    RunMessages messages(run, options, true);
    EXPECT_EQ(messages.build(run, {})->camera.has_value(), row < 2);
    EXPECT_FALSE(messages.build(run, {})->camera) << "it has not moved";
  }
}

TEST(Markers, SpringsAreColouredByStrainAndParticlesByMass) {
  Scene scene = horizontal(4);
  scene.state.x()[2] = 1.5;  // springs of 1, 0.5 and 98.5 m
  scene.state.x()[3] = 100.0;
  scene.masses.view() << 1.0, 1.0, 10.0, 100.0;
  const test::ProgramRun run(Scenario{}, scene, {false, 0.0});
  const auto markers = markersOf(run, NodeOptions{}).markers;
  const auto& springs = markers[0].colors;
  EXPECT_EQ(springs[0].r, springs[0].b);  // relaxed: no hue
  EXPECT_LT(springs[2].r, springs[2].b);  // short: bluish
  EXPECT_GT(springs[4].r, springs[4].b);  // long: reddish
  EXPECT_LT(springs[4].r, 0.9F);          // overstretched: dark
  const auto& particles = markers[1].colors;
  EXPECT_FLOAT_EQ(particles[2].g, 0.5F * (particles[1].g + particles[3].g));  // logarithmic
  EXPECT_GT(particles[1].g, particles[3].g);
}

TEST(Markers, OneColourForTheWholeChainOnRequest) {
  const test::ProgramRun run(Scenario{}, horizontal(3), {false, 0.0});
  NodeOptions options;
  options.color = "#ff8000";
  const auto markers = markersOf(run, options).markers;
  for (const auto& color : markers[0].colors) EXPECT_EQ(rgba(color), rgba(colorOf(0xff8000)));
  EXPECT_EQ(rgba(markers[3].color), rgba(colorOf("#ff8000")));
}

TEST(StateMessage, LiesInThePlaneXZ) {
  Scenario scenario;
  test::ProgramRun run(scenario, horizontal(3), {true, 0.0});
  run.advance();
  PendulumState message;
  setState(message, run, std_msgs::Header());
  EXPECT_EQ(message.positions[2].x, run.state().x()[2]);
  EXPECT_EQ(message.positions[2].y, 0.0);
  EXPECT_EQ(message.positions[2].z, run.state().y()[2]);
  EXPECT_EQ(message.velocities[2].z, run.state().vy()[2]);
  EXPECT_EQ(message.frame, 1);
  EXPECT_EQ(message.method, "Runge-Kutta-4");
  EXPECT_EQ(message.position_error, run.positionError().now);
  EXPECT_EQ(message.largest_position_error, run.positionError().largest);
  EXPECT_EQ(message.position_error_measured_until, 0.1);
}

TEST(StateMessage, LargestStretchIsRelativeToTheRestLength) {
  for (const auto& [rest_length, particles, stretch] :
       {std::tuple(0.5, 3, 1.0), std::tuple(0.0, 3, 1.0), std::tuple(0.5, 1, 0.0)}) {
    Scenario scenario;
    scenario.constants.spring.rest_length = rest_length;
    const test::ProgramRun run(scenario, horizontal(particles), {false, 0.0});
    PendulumState message;
    setState(message, run, std_msgs::Header());
    EXPECT_DOUBLE_EQ(message.largest_stretch, stretch);
  }
}

TEST(Parameters, RawValuesBecomeTheTextThatWasMeant) {
  XmlRpc::XmlRpcValue whole(4), real(0.001), yes(true), text("1e-3"), list;
  list[0] = 1;
  EXPECT_EQ(parameterText(whole, "/node: frames"), "4");
  EXPECT_EQ(parameterText(real, "/node: time_step"), "0.001");
  EXPECT_EQ(parameterText(yes, "/node: no_frames"), "true");
  EXPECT_EQ(parameterText(text, "/node: time_step"), "1e-3");
  EXPECT_THROW(parameterText(list, "/node: frames"), InputError);
}

TEST(Parameters, EveryOptionReadsItsOwnDefault) {
  NodeOptions defaults;
  OptionSet options(displayOptions(defaults));
  options.add(playOptions(defaults));
  for (const Option& option : options.options()) {
    const std::string text = option.text();
    option.assign(text);
    EXPECT_EQ(option.text(), text) << option.key;
  }
}

}  // namespace
}  // namespace spring_pendulum
