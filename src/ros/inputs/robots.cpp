#include "ros/inputs/robots.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <fmt/format.h>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <nav_msgs/Odometry.h>
#include <sstream>
#include <tf2_msgs/TFMessage.h>

namespace spring_pendulum {
namespace {

constexpr double kOutOfPlane = 1e-3;  // m
constexpr double kStaleFrame = 1.0;   // s, until an unchanged frame is forgotten

double steadySeconds() {
  return ros::SteadyTime::now().toSec();
}

/// Returns the force on the holder of a particle, N, as the sensor of a gripper would feel it: springs,
/// weight and inertia. The mass of P_1 is not used.
PlaneVector<double> forceOnHolder(const Run& run, std::ptrdiff_t particle) {
  const Chain& chain = run.chain();
  PlaneVector<double> force{};
  if (particle + 1 < chain.size()) force = springForceOn(chain, run.state(), particle);
  if (particle == 0) return force;
  const PlaneVector<double> above = springForceOn(chain, run.state(), particle - 1);
  PlaneVector<double> acceleration{};
  for (const HeldParticle& held : chain.drive().held) {
    if (held.particle == particle) acceleration = held.acceleration;
  }
  const double mass = chain.masses()[particle];
  return {force.x - above.x - mass * acceleration.x,
          force.y - above.y - mass * (chain.gravity() + acceleration.y)};
}

}  // namespace

std::vector<std::ptrdiff_t> parseParticleList(const std::string& text, std::ptrdiff_t particles,
                                              const std::string& key) {
  std::vector<std::ptrdiff_t> result;
  std::string words = text;
  std::replace(words.begin(), words.end(), ',', ' ');
  std::istringstream stream(words);
  for (std::string word; stream >> word;) {
    const std::optional<double> number =
        word == "last" ? std::optional<double>(static_cast<double>(particles)) : parseNumber(word);
    if (!number || *number != std::floor(*number) || *number < 1.0 ||
        *number > static_cast<double>(particles)) {
      throw InputError(fmt::format("{}: {} is not a particle of the chain: use 1 to {}, or last",
                                   key, inQuotes(word), particles));
    }
    result.push_back(static_cast<std::ptrdiff_t>(*number) - 1);
    if (std::count(result.begin(), result.end(), result.back()) > 1) {
      throw InputError(fmt::format("{}: particle {} is given twice", key, result.back() + 1));
    }
  }
  return result;
}

Robots::Robots(ros::NodeHandle& node, const Run& run, const NodeOptions& options, Driver& driver,
               Frames& frames)
    : run_(run), driver_(driver), frames_(frames) {
  const double longest = std::max(1.0, 0.5 * chainLength(run.chain(), run.start()));
  auto held_frames = options.held_frames;
  for (const std::ptrdiff_t particle :
       parseParticleList(options.held, run.chain().size(), "held")) {
    const std::string name = fmt::format("held_{}", particle + 1);
    const std::string frame = held_frames[particle + 1];
    held_frames.erase(particle + 1);
    const Follower follower(frame.empty() ? name : "frame " + frame, longest);
    connect(node, robots_.emplace_back(Robot{particle, name, frame, follower}));
  }
  if (!held_frames.empty()) {
    throw InputError(
        fmt::format("held_{0}_frame: particle {0} is not in held", held_frames.begin()->first));
  }
  tf_particles_ = parseParticleList(options.tf_particles, run.chain().size(), "tf_particles");
  if (!tf_particles_.empty()) tf_ = node.advertise<tf2_msgs::TFMessage>("/tf", 100);
  if (!robots_.empty()) frames_.listen();
  reset();
}

void Robots::connect(ros::NodeHandle& node, Robot& robot) {
  robot.wrench = node.advertise<geometry_msgs::WrenchStamped>(robot.name + "/wrench", 100);
  if (!robot.frame.empty()) return;
  robot.odometry = node.subscribe<nav_msgs::Odometry>(
      robot.name + "/odom", 10, [this, &robot](const nav_msgs::Odometry::ConstPtr& message) {
        const auto& [pose, twist] = std::tie(message->pose.pose, message->twist.twist.linear);
        receive(robot, message->header, pose.position,
                rotation(pose.orientation) * tf2::Vector3(twist.x, twist.y, twist.z));
      });
  robot.pose = node.subscribe<geometry_msgs::PoseStamped>(
      robot.name + "/pose", 10,
      [this, &robot](const geometry_msgs::PoseStamped::ConstPtr& message) {
        receive(robot, message->header, message->pose.position, std::nullopt);
      });
}

void Robots::reset() {
  for (Robot& robot : robots_) {
    robot.follower.restart();
    driver_.on(Hold{robot.particle, {}});
  }
}

void Robots::receive(Robot& robot, const std_msgs::Header& header,
                     const geometry_msgs::Point& point,
                     const std::optional<tf2::Vector3>& velocity) {
  try {
    take(robot, {frames_.from(header.frame_id).transform, header.stamp.toSec()}, point, velocity,
         steadySeconds());
  } catch (const InputError& error) {
    if (robot.warnings.isDue()) ROS_WARN_STREAM(robot.name << ": " << error.what());
  }
}

void Robots::lookUp(Robot& robot, double now) {
  try {
    const StampedTransform found = frames_.from(robot.frame);
    if (found.stamp == robot.stamp && found.stamp != 0.0) {
      if (robot.follower.isSilent(now - kStaleFrame)) frames_.forget();
      return;
    }
    robot.stamp = found.stamp;
    // It came when tf received it, not when it is looked up, unless its clock is another one.
    const double age = ros::Time::now().toSec() - found.stamp;
    take(robot, found, {}, std::nullopt, age > 0.0 && age < kStaleFrame ? now - age : now);
  } catch (const InputError& error) {
    if (robot.follower.isSilent(now) && robot.warnings.isDue()) {
      ROS_WARN_STREAM(robot.name << "_frame: " << error.what());
    }
  }
}

void Robots::take(Robot& robot, const StampedTransform& transform,
                  const geometry_msgs::Point& point, const std::optional<tf2::Vector3>& velocity,
                  double now) {
  const tf2::Vector3 at = transform.transform * tf2::Vector3(point.x, point.y, point.z);
  const tf2::Vector3 speed =
      transform.transform.getBasis() * velocity.value_or(tf2::Vector3(0.0, 0.0, 0.0));
  const bool accepted = robot.follower.take({{at.x(), at.z()}, {speed.x(), speed.z()}, {}},
                                            velocity.has_value(), transform.stamp, now);
  const std::string message = robot.follower.takeMessage();
  if (!message.empty()) ROS_WARN_STREAM(message);
  if (accepted && !robot.warned && !(std::abs(at.y()) <= kOutOfPlane)) {
    robot.warned = true;
    ROS_WARN_STREAM(robot.name << ": the input is " << std::abs(at.y())
                               << " m out of the plane of the motion: projected into it");
  }
}

void Robots::follow(double real_time_factor) {
  const double now = steadySeconds();
  const double share = real_time_factor > 0.0 ? 1.0 / real_time_factor : 0.0;
  for (Robot& robot : robots_) {
    if (!robot.frame.empty()) lookUp(robot, now);
    const PlaneVector<double> here{run_.state().x()[robot.particle],
                                   run_.state().y()[robot.particle]};
    auto target = robot.follower.targetAt(now, here, share * (run_.nextTime() - run_.time()));
    const std::string message = robot.follower.takeMessage();
    if (!message.empty()) ROS_WARN_STREAM(message);
    if (!target) continue;
    // From seconds to simulated seconds.
    target->velocity = {share * target->velocity.x, share * target->velocity.y};
    target->acceleration = {share * share * target->acceleration.x,
                            share * share * target->acceleration.y};
    driver_.on(Hold{robot.particle, target});
  }
}

void Robots::show(const std_msgs::Header& header) {
  for (const Robot& robot : robots_) {
    if (robot.wrench.getNumSubscribers() == 0) continue;
    const PlaneVector<double> force = forceOnHolder(run_, robot.particle);
    geometry_msgs::WrenchStamped message;
    message.header = header;
    message.wrench.force.x = force.x;
    message.wrench.force.z = force.y;
    robot.wrench.publish(message);
  }
  if (tf_particles_.empty()) return;
  tf2_msgs::TFMessage message;
  for (const std::ptrdiff_t i : tf_particles_) {
    auto& transform = message.transforms.emplace_back();
    transform.header = header;
    transform.child_frame_id =
        fmt::format("{}/particle_{}", ros::this_node::getName().substr(1), i + 1);
    transform.transform.translation.x = run_.state().x()[i];
    transform.transform.translation.z = run_.state().y()[i];
    transform.transform.rotation.w = 1.0;
  }
  tf_.publish(message);
}

}  // namespace spring_pendulum
