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
#include <map>
#include <nav_msgs/Odometry.h>
#include <regex>
#include <sstream>

namespace spring_pendulum {
namespace {

constexpr double kOutOfPlane = 1e-3;       // m
constexpr double kUnknownInterval = 1e-3;  // s

/// Returns the force that the sensor of a gripper would feel, N: springs, weight, inertia and air; of P_1 the spring.
PlaneVector<double> forceOnHolder(const Run& run, std::ptrdiff_t particle) {
  const Chain& chain = run.chain();
  PlaneVector<double> force{};
  if (particle + 1 < chain.size()) force = springForceOn(chain, run.state(), particle);
  if (particle == 0) return force;
  const PlaneVector<double> above = springForceOn(chain, run.state(), particle - 1);
  PlaneVector<double> a{};
  for (const HeldParticle& held : chain.drive().held)
    if (held.particle == particle) a = held.acceleration;
  const double mass = chain.masses()[particle], air = chain.airDrag();
  return {force.x - above.x - mass * a.x - air * run.state().vx()[particle],
          force.y - above.y - mass * (chain.gravity() + a.y) - air * run.state().vy()[particle]};
}

}  // namespace

std::vector<HolderFrame> parseHeld(const std::string& text, std::ptrdiff_t particles) {
  std::map<std::ptrdiff_t, std::string> held;
  std::istringstream words(std::regex_replace(text, std::regex(","), " "));
  for (std::string word; words >> word;) {
    const std::string name = word.substr(0, word.find('='));
    const auto number = name == "last" ? particles : parseInteger(name).value_or(0);
    if (number < 1 || number > particles)
      throw InputError(fmt::format("held: {} is not a particle of the chain: use 1 to {}, or last",
                                   inQuotes(name), particles));
    if (!held.emplace(number - 1, name == word ? "" : word.substr(name.size() + 1)).second)
      throw InputError(fmt::format("held: particle {} is given twice", number));
  }
  return {held.begin(), held.end()};
}

Robots::Robots(ros::NodeHandle& node, const Run& run, const NodeOptions& options, Driver& driver,
               Frames& frames)
    : run_(run), driver_(driver), frames_(frames) {
  const double longest = std::max(1.0, 0.5 * chainLength(run.chain(), run.start()));
  const auto warn = [](const std::string& text) { ROS_WARN_STREAM(text); };
  for (const auto& [particle, frame] : parseHeld(options.held, run.chain().size())) {
    const std::string name = fmt::format("held_{}", particle + 1);
    const std::string of_frame = frame.empty() ? "" : fmt::format(" (frame {})", frame);
    const Follower follower(name + of_frame, longest, warn);
    Robot& robot = robots_.emplace_back(Robot{particle, name, frame, follower});
    robot.wrench = node.advertise<geometry_msgs::WrenchStamped>(name + "/wrench", 1000);
    if (!frame.empty()) continue;
    robot.odometry = node.subscribe<nav_msgs::Odometry>(
        name + "/odom", 10, [this, &robot](const nav_msgs::Odometry::ConstPtr& message) {
          receive(robot, message->header, message->pose.pose.position);
        });
    robot.pose = node.subscribe<geometry_msgs::PoseStamped>(
        name + "/pose", 10, [this, &robot](const geometry_msgs::PoseStamped::ConstPtr& message) {
          receive(robot, message->header, message->pose.position);
        });
  }
  if (!robots_.empty()) frames_.listen();
  reset();
}

void Robots::reset() {
  for (Robot& robot : robots_) {
    robot.follower.restart();
    driver_.on(Hold{robot.particle, {}});
  }
}

void Robots::receive(Robot& robot, const std_msgs::Header& header,
                     const geometry_msgs::Point& point) {
  try {
    take(robot, {frames_.from(header.frame_id).transform, header.stamp.toSec()}, point,
         ros::SteadyTime::now().toSec());
  } catch (const InputError& error) {
    if (robot.warnings.isDue()) ROS_WARN_STREAM(robot.name << ": " << error.what());
  }
}

void Robots::take(Robot& robot, const StampedTransform& frame, const geometry_msgs::Point& point,
                  double now) {
  const tf2::Vector3 at = frame.transform * tf2::Vector3(point.x, point.y, point.z);
  const bool accepted = robot.follower.take({at.x(), at.z()}, frame.stamp, now);
  if (accepted && !robot.warned && !(std::abs(at.y()) <= kOutOfPlane)) {
    robot.warned = true;
    ROS_WARN_STREAM(robot.name << ": the input is " << std::abs(at.y())
                               << " m out of the plane of the motion: projected into it");
  }
}

void Robots::lookUp() {
  const double now = ros::SteadyTime::now().toSec();
  for (Robot& robot : robots_) {
    if (robot.frame.empty()) continue;
    try {
      const StampedTransform found = frames_.from(robot.frame);
      if (found.stamp == robot.stamp && found.stamp != 0.0) continue;
      robot.stamp = found.stamp;
      take(robot, found, {}, now);
    } catch (const InputError& error) {
      if (robot.follower.isSilent(now) && robot.warnings.isDue())
        ROS_WARN_STREAM(robot.name << ": " << error.what());
    }
  }
}

void Robots::follow(double real_time_factor, double next_time) {
  lookUp();
  const double now = ros::SteadyTime::now().toSec();
  const double share = real_time_factor > 0.0 ? 1.0 / real_time_factor : 0.0;
  const double step = next_time - run_.time();
  const double interval = share == 0.0 && step > 0.0 ? kUnknownInterval : share * step;
  for (Robot& robot : robots_) {
    const PlaneVector<double> here{run_.state().x()[robot.particle],
                                   run_.state().y()[robot.particle]};
    auto target = robot.follower.targetAt(now, here, interval);
    if (!target) continue;
    if (share > 0.0) target->fastest *= share;  // from seconds to simulated seconds
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
}

}  // namespace spring_pendulum
