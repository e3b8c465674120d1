#include "ros/inputs/robots.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "ros/inputs/follower.hpp"
#include "ros/messages/throttle.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/simulation/reference_run.hpp>

#include <fmt/format.h>

#include <geometry_msgs/WrenchStamped.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <tf2_msgs/TFMessage.h>
#include <utility>

namespace spring_pendulum {
namespace {

constexpr double kOutOfPlane = 1e-3;  // m

double steadySeconds() {
  return ros::SteadyTime::now().toSec();
}

geometry_msgs::Vector3 vectorOf(const geometry_msgs::Point& point) {
  geometry_msgs::Vector3 vector;
  vector.x = point.x;
  vector.y = point.y;
  vector.z = point.z;
  return vector;
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

struct Robots::Robot {
  explicit Robot(InputCheck check) : follower(std::move(check)) {}

  std::ptrdiff_t particle = 0;
  std::string frame;  ///< empty: topics
  Follower follower;
  double stamp = -1.0;  ///< s, of the last transform
  Throttle warnings;
  bool warned = false;  ///< of a position out of the plane
  ros::Subscriber odometry, pose;
  ros::Publisher wrench;
};

Robots::~Robots() = default;

Robots::Robots(ros::NodeHandle& node, const Run& run, const NodeOptions& options, Driver& driver,
               Frames& frames)
    : run_(run), driver_(driver), frames_(frames), y_(options.y_offset) {
  const std::ptrdiff_t size = run.chain().size();
  const double longest = std::max(1.0, 0.5 * chainLength(run.chain(), run.start()));
  for (const std::ptrdiff_t particle : parseParticleList(options.held, size, "held")) {
    const std::string topic = fmt::format("held_{}", particle + 1);
    const auto frame = options.held_frames.find(particle + 1);
    const std::string name =
        frame == options.held_frames.end() ? topic : fmt::format("frame {}", frame->second);
    robots_.push_back(std::make_unique<Robot>(InputCheck(name, longest)));
    Robot& robot = *robots_.back();
    robot.particle = particle;
    if (frame != options.held_frames.end()) robot.frame = frame->second;
    robot.wrench = node.advertise<geometry_msgs::WrenchStamped>(topic + "/wrench", 100);
    if (!robot.frame.empty()) continue;
    robot.odometry = node.subscribe<nav_msgs::Odometry>(
        topic + "/odom", 10, [this, &robot](const nav_msgs::Odometry::ConstPtr& message) {
          const auto& twist = message->twist.twist.linear;
          take(robot, message->header, vectorOf(message->pose.pose.position),
               rotated(message->pose.pose.orientation, twist.x, twist.y, twist.z));
        });
    robot.pose = node.subscribe<geometry_msgs::PoseStamped>(
        topic + "/pose", 10, [this, &robot](const geometry_msgs::PoseStamped::ConstPtr& message) {
          take(robot, message->header, vectorOf(message->pose.position), std::nullopt);
        });
  }
  for (const auto& [particle, frame] : options.held_frames) {
    const bool is_held =
        std::any_of(robots_.begin(), robots_.end(),
                    [&, number = particle](auto& robot) { return robot->particle + 1 == number; });
    if (!is_held)
      throw InputError(
          fmt::format("held_{}_frame: particle {} is not in held", particle, particle));
  }
  tf_particles_ = parseParticleList(options.tf_particles, size, "tf_particles");
  if (!tf_particles_.empty()) tf_ = node.advertise<tf2_msgs::TFMessage>("/tf", 100);
  if (!robots_.empty()) frames_.listen();
  reset();
}

void Robots::reset() {
  for (const auto& robot : robots_) {
    robot->follower.restart();
    driver_.on(Hold{robot->particle, {}});
  }
}

void Robots::say(Robot& robot) {
  const std::string message = robot.follower.takeMessage();
  if (!message.empty()) ROS_WARN_STREAM(message);
}

void Robots::take(Robot& robot, const std_msgs::Header& header,
                  const geometry_msgs::Vector3& position,
                  const std::optional<geometry_msgs::Vector3>& velocity) {
  geometry_msgs::Vector3 place, speed;
  try {
    const auto transform = frames_.from(header.frame_id).transform;
    place = transformed(transform, position);
    if (velocity) speed = rotated(transform.rotation, velocity->x, velocity->y, velocity->z);
  } catch (const InputError& error) {
    if (robot.warnings.isDue()) {
      ROS_WARN_STREAM("held_" << robot.particle + 1 << ": " << error.what());
    }
    return;
  }
  const PlaneVector<double> at{place.x, place.z};
  const bool accepted = robot.follower.take({at, {speed.x, speed.z}, {}}, velocity.has_value(),
                                            header.stamp.toSec(), steadySeconds());
  say(robot);
  if (!accepted) return;
  if (!robot.warned && !(std::abs(place.y - y_) <= kOutOfPlane)) {
    robot.warned = true;
    ROS_WARN_STREAM("held_" << robot.particle + 1 << ": the input is " << std::abs(place.y - y_)
                            << " m out of the plane of the motion: projected into it");
  }
}

void Robots::lookUp(Robot& robot, double now) {
  try {
    const auto transform = frames_.from(robot.frame);
    const double stamp = transform.header.stamp.toSec();
    // Static transforms have stamp 0: always current.
    if (stamp == robot.stamp && stamp != 0.0) return;
    robot.stamp = stamp;
    std_msgs::Header header = transform.header;
    header.frame_id.clear();
    take(robot, header, transformed(transform.transform, geometry_msgs::Point()), std::nullopt);
  } catch (const InputError& error) {
    if (robot.follower.isSilent(now) && robot.warnings.isDue()) {
      ROS_WARN_STREAM("held_" << robot.particle + 1 << "_frame: " << error.what());
    }
  }
}

void Robots::follow(double real_time_factor) {
  const double now = steadySeconds();
  for (const auto& robot : robots_) {
    if (!robot->frame.empty()) lookUp(*robot, now);
    const PlaneVector<double> here{run_.state().x()[robot->particle],
                                   run_.state().y()[robot->particle]};
    const double speed = real_time_factor;
    const double interval = speed > 0.0 ? (run_.nextTime() - run_.time()) / speed : 0.0;
    auto target = robot->follower.targetAt(now, here, interval);
    say(*robot);
    if (target) {  // from seconds to simulated seconds
      const double share = speed > 0.0 ? 1.0 / speed : 0.0;
      target->velocity = {share * target->velocity.x, share * target->velocity.y};
      target->acceleration = {share * share * target->acceleration.x,
                              share * share * target->acceleration.y};
    }
    if (target) driver_.on(Hold{robot->particle, target});
  }
}

/// Adds the weight and the inertia of a held particle, as the sensor of a gripper would feel them. The mass of
/// P_1 is not used.
void Robots::addWeight(std::ptrdiff_t particle, geometry_msgs::Vector3& force) const {
  const Chain& chain = run_.chain();
  PlaneVector<double> acceleration{};
  for (const HeldParticle& held : chain.drive().held) {
    if (held.particle == particle) acceleration = held.acceleration;
  }
  force.x -= chain.masses()[particle] * acceleration.x;
  force.z -= chain.masses()[particle] * (chain.gravity() + acceleration.y);
}

void Robots::show(const std_msgs::Header& header) {
  for (const auto& robot : robots_) {
    if (robot->wrench.getNumSubscribers() == 0) continue;
    geometry_msgs::WrenchStamped message;
    message.header = header;
    const std::ptrdiff_t i = robot->particle;
    if (i + 1 < run_.chain().size()) {
      const PlaneVector<double> force = springForceOn(run_.chain(), run_.state(), i);
      message.wrench.force.x += force.x;
      message.wrench.force.z += force.y;
    }
    if (i > 0) {
      const PlaneVector<double> force = springForceOn(run_.chain(), run_.state(), i - 1);
      message.wrench.force.x -= force.x;
      message.wrench.force.z -= force.y;
    }
    if (i > 0) addWeight(i, message.wrench.force);
    robot->wrench.publish(message);
  }
  if (tf_particles_.empty()) return;
  tf2_msgs::TFMessage message;
  for (const std::ptrdiff_t i : tf_particles_) {
    geometry_msgs::TransformStamped transform;
    transform.header = header;
    transform.child_frame_id =
        fmt::format("{}/particle_{}", ros::this_node::getName().substr(1), i + 1);
    transform.transform.translation.x = run_.state().x()[i];
    transform.transform.translation.y = y_;
    transform.transform.translation.z = run_.state().y()[i];
    transform.transform.rotation.w = 1.0;
    message.transforms.push_back(transform);
  }
  tf_.publish(message);
}

}  // namespace spring_pendulum
