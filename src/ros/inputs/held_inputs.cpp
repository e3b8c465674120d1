#include "ros/inputs/held_inputs.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
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

constexpr double kSilence = 0.5;          // s
constexpr double kOutOfPlane = 1e-3;      // m
constexpr double kApproachSpeed = 1.0;    // m/s, before a particle has met its holder
constexpr double kMet = 0.01;             // m
constexpr double kJumpsPerSecond = 10.0;  // largest believable speed, in largest jumps per second

double wallTime() {
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

bool HolderCheck::refuse(const std::string& why) {
  if (!said_) message_ = fmt::format("{} {}: the particle is held where it is", name_, why);
  said_ = true;
  return false;
}

bool HolderCheck::accepts(const PlaneVector<double>& position, const PlaneVector<double>& velocity,
                          double stamp, double now) {
  if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(velocity.x) ||
      !std::isfinite(velocity.y)) {
    return refuse("has numbers that are not finite");
  }
  const double fastest = kJumpsPerSecond * longest_;
  if (!(std::hypot(velocity.x, velocity.y) <= fastest)) {
    return refuse(fmt::format("moves at more than {:.3g} m/s", fastest));
  }
  if (last_ && stamp < last_stamp_) return refuse("runs backwards in time");
  if (last_ && !(std::hypot(position.x - last_->x, position.y - last_->y) <= longest_)) {
    return refuse(fmt::format("jumps by more than {:.3g} m", longest_));
  }
  if (said_ || silent_) message_ = fmt::format("{} is followed again", name_);
  said_ = silent_ = false;
  last_ = position;
  last_stamp_ = stamp;
  last_time_ = now;
  return true;
}

bool HolderCheck::isAlive(double now) {
  if (!last_ || now - last_time_ < kSilence) return last_.has_value();
  if (!silent_ && !said_) {
    message_ = fmt::format("{} has stopped: the particle is held where it is", name_);
  }
  silent_ = true;
  return false;
}

bool Follower::take(const Target& input, double stamp, double now) {
  if (!check_.accepts(input.position, input.velocity, stamp, now)) return false;
  input_ = input;
  taken_ = now;
  return true;
}

std::optional<Target> Follower::targetAt(double now, const PlaneVector<double>& here,
                                         double interval) {
  const bool alive = check_.isAlive(now);
  if (!input_) return std::nullopt;
  Target target = *input_;
  const double dx = target.position.x - here.x, dy = target.position.y - here.y;
  const double distance = std::hypot(dx, dy);
  met_ = met_ || distance < kMet;
  const double step = kApproachSpeed * std::max(interval, 1e-3);
  if (!alive) {
    target.velocity = {};
  } else if (!met_ && distance > 2.0 * step) {
    const double share = 2.0 * step / distance;
    target = {{here.x + share * dx, here.y + share * dy}, {}};
  } else {
    // The particle reaches where its holder is now, in a frame that moves with the holder.
    const double age = now - taken_;
    target.position.x += age * target.velocity.x;
    target.position.y += age * target.velocity.y;
  }
  return target;
}

bool Follower::isSilent(double now) const {
  return !input_ || now - taken_ > kSilence;
}

void Follower::restart() {
  input_.reset();
  met_ = false;
  check_.restart();
}

struct HeldInputs::Held {
  explicit Held(HolderCheck check) : follower(std::move(check)) {}

  std::ptrdiff_t particle = 0;
  std::string frame;  ///< empty: topics
  Follower follower;
  double stamp = -1.0;  ///< s, of the last transform
  bool warned = false;  ///< of a position out of the plane
  ros::Subscriber odometry, pose;
  ros::Publisher wrench;
};

HeldInputs::~HeldInputs() = default;

HeldInputs::HeldInputs(ros::NodeHandle& node, const Run& run, const NodeOptions& options,
                       Holders& holders, Frames& frames)
    : run_(run), holders_(holders), frames_(frames), y_(options.y_offset) {
  const std::ptrdiff_t size = run.chain().size();
  const double longest = std::max(1.0, 0.5 * chainLength(run.chain(), run.start()));
  for (const std::ptrdiff_t particle : parseParticleList(options.held, size, "held")) {
    const std::string topic = fmt::format("held_{}", particle + 1);
    const auto frame = options.held_frames.find(particle + 1);
    const std::string name =
        frame == options.held_frames.end() ? topic : fmt::format("frame {}", frame->second);
    held_.push_back(std::make_unique<Held>(HolderCheck(name, longest)));
    Held& held = *held_.back();
    held.particle = particle;
    if (frame != options.held_frames.end()) held.frame = frame->second;
    held.wrench = node.advertise<geometry_msgs::WrenchStamped>(topic + "/wrench", 100);
    if (!held.frame.empty()) continue;
    held.odometry = node.subscribe<nav_msgs::Odometry>(
        topic + "/odom", 10, [this, &held](const nav_msgs::Odometry::ConstPtr& message) {
          const auto& twist = message->twist.twist.linear;
          take(held, message->header, vectorOf(message->pose.pose.position),
               rotated(message->pose.pose.orientation, twist.x, twist.y, twist.z));
        });
    held.pose = node.subscribe<geometry_msgs::PoseStamped>(
        topic + "/pose", 10, [this, &held](const geometry_msgs::PoseStamped::ConstPtr& message) {
          take(held, message->header, vectorOf(message->pose.position), {});
        });
  }
  for (const auto& [particle, frame] : options.held_frames) {
    const bool is_held =
        std::any_of(held_.begin(), held_.end(),
                    [&, number = particle](auto& held) { return held->particle + 1 == number; });
    if (!is_held)
      throw InputError(
          fmt::format("held_{}_frame: particle {} is not in held", particle, particle));
  }
  tf_particles_ = parseParticleList(options.tf_particles, size, "tf_particles");
  if (!tf_particles_.empty()) tf_ = node.advertise<tf2_msgs::TFMessage>("/tf", 100);
  if (!held_.empty()) frames_.listen();
  reset();
}

void HeldInputs::reset() {
  for (const auto& held : held_) {
    held->follower.restart();
    holders_.hold(held->particle);
  }
}

void HeldInputs::say(Held& held) {
  const std::string message = held.follower.takeMessage();
  if (!message.empty()) ROS_WARN_STREAM(message);
}

void HeldInputs::take(Held& held, const std_msgs::Header& header,
                      const geometry_msgs::Vector3& position,
                      const geometry_msgs::Vector3& velocity) {
  geometry_msgs::Vector3 place, speed;
  try {
    const auto transform = frames_.from(header.frame_id).transform;
    place = transformed(transform, position);
    speed = rotated(transform.rotation, velocity.x, velocity.y, velocity.z);
  } catch (const InputError& error) {
    ROS_WARN_STREAM_THROTTLE(5.0, "held_" << held.particle + 1 << ": " << error.what());
    return;
  }
  const PlaneVector<double> at{place.x, place.z};
  const bool accepted =
      held.follower.take({at, {speed.x, speed.z}}, header.stamp.toSec(), wallTime());
  say(held);
  if (!accepted) return;
  if (!held.warned && !(std::abs(place.y - y_) <= kOutOfPlane)) {
    held.warned = true;
    ROS_WARN_STREAM("held_" << held.particle + 1 << ": the input is " << std::abs(place.y - y_)
                            << " m out of the plane of the motion: projected into it");
  }
}

void HeldInputs::lookUp(Held& held, double now) {
  try {
    const auto transform = frames_.from(held.frame);
    const double stamp = transform.header.stamp.toSec();
    // Static transforms have stamp 0: always current.
    if (stamp == held.stamp && stamp != 0.0) return;
    held.stamp = stamp;
    std_msgs::Header header = transform.header;
    header.frame_id.clear();
    take(held, header, transformed(transform.transform, geometry_msgs::Point()), {});
  } catch (const InputError& error) {
    if (held.follower.isSilent(now)) {
      ROS_WARN_STREAM_THROTTLE(5.0, "held_" << held.particle + 1 << "_frame: " << error.what());
    }
  }
}

void HeldInputs::watch() {
  const double now = wallTime();
  for (const auto& held : held_) {
    if (!held->frame.empty()) lookUp(*held, now);
    const PlaneVector<double> here{run_.state().x()[held->particle],
                                   run_.state().y()[held->particle]};
    const auto target = held->follower.targetAt(now, here, run_.nextTime() - run_.time());
    say(*held);
    if (target) holders_.hold(held->particle, *target);
  }
}

void HeldInputs::show(const std_msgs::Header& header) {
  for (const auto& held : held_) {
    if (held->wrench.getNumSubscribers() == 0) continue;
    geometry_msgs::WrenchStamped message;
    message.header = header;
    const std::ptrdiff_t i = held->particle;
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
    held->wrench.publish(message);
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
