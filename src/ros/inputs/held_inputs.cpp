#include "ros/inputs/held_inputs.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "ros/inputs/answer.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/simulation/reference_run.hpp>

#include <fmt/format.h>

#include <geometry_msgs/WrenchStamped.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <tf2_msgs/TFMessage.h>
#include <utility>

namespace spring_pendulum {
namespace {

constexpr double kSilence = 0.5;        // s
constexpr double kOutOfPlane = 1e-3;    // m
constexpr double kApproachSpeed = 1.0;  // m/s, before a particle has met its holder
constexpr double kMet = 0.01;           // m
constexpr double kJitter = 0.1;         // s, largest believable delay of a message
constexpr double kHistory = 0.5;        // s, of inputs
constexpr double kBaseline = 0.03;  // s, least time between inputs whose difference is a velocity
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

HolderCheck::Answer HolderCheck::refuse(const std::string& why) {
  if (!said_) say(" " + why + ": the particle is held where it is");
  said_ = true;
  return Answer::kRefused;
}

bool HolderCheck::follows(const Seen& before, const Seen& input) const {
  const double distance =
      std::hypot(input.position.x - before.position.x, input.position.y - before.position.y);
  return input.stamp >= before.stamp && distance <= longest_;
}

HolderCheck::Answer HolderCheck::check(const PlaneVector<double>& position,
                                       const PlaneVector<double>& velocity, double stamp,
                                       double now) {
  if (!std::isfinite(position.x) || !std::isfinite(position.y) || !std::isfinite(velocity.x) ||
      !std::isfinite(velocity.y)) {
    return refuse("has numbers that are not finite");
  }
  const double fastest = kJumpsPerSecond * longest_;
  if (!(std::hypot(velocity.x, velocity.y) <= fastest)) {
    return refuse(fmt::format("moves at more than {:.3g} m/s", fastest));
  }
  const Seen input{position, stamp, now};
  bool returns = !last_ || now - last_->time >= kSilence;
  if (last_ && !follows(*last_, input)) {
    if (!refused_ || !follows(*refused_, input)) steady_since_ = now;
    refused_ = input;
    returns = now - steady_since_ >= kSilence;
    if (!returns) {
      return refuse(stamp < last_->stamp ? "runs backwards in time"
                                         : fmt::format("jumps by more than {:.3g} m", longest_));
    }
  }
  if (said_ || silent_) say(" is followed again");
  said_ = silent_ = false;
  refused_.reset();
  last_ = input;
  return returns ? Answer::kReturns : Answer::kFollows;
}

bool HolderCheck::isAlive(double now) {
  if (!last_ || now - last_->time < kSilence) return last_.has_value();
  if (!silent_ && !said_) say(" has stopped: the particle is held where it is");
  silent_ = true;
  return false;
}

bool Follower::take(const Target& input, bool has_velocity, double stamp, double now) {
  const HolderCheck::Answer answer = check_.check(input.position, input.velocity, stamp, now);
  if (answer == HolderCheck::Answer::kRefused) return false;
  if (answer == HolderCheck::Answer::kReturns) {
    samples_.clear();
    met_ = false;
    left_ = 0.0;
  }
  // Differences of stamps have no jitter; but they may come from another clock.
  double time = now;
  if (!samples_.empty()) {
    const double expected = samples_.back().time + (stamp - samples_.back().stamp);
    if (stamp > samples_.back().stamp && std::abs(now - expected) < kJitter) {
      time = std::min(now, expected);
    }
  }
  samples_.push_back({input, stamp, time});
  while (samples_.front().time < time - kHistory) samples_.pop_front();
  estimateMotion(has_velocity);
  return true;
}

const Follower::Sample* Follower::before(double seconds) const {
  const Sample* found = nullptr;
  for (const Sample& sample : samples_) {
    if (samples_.back().time - sample.time >= seconds) found = &sample;
  }
  return found;
}

// Poses: the parabola through three inputs. Odometry: the change of the velocity between two.
void Follower::estimateMotion(bool has_velocity) {
  Target& now = samples_.back().holder;
  const Sample* const first = before(kBaseline);
  if (first == nullptr) return;
  const auto slope = [](const PlaneVector<double>& from, const PlaneVector<double>& to,
                        double time) {
    return PlaneVector<double>{(to.x - from.x) / time, (to.y - from.y) / time};
  };
  const double h1 = samples_.back().time - first->time;
  if (has_velocity) {
    now.acceleration = slope(first->holder.velocity, now.velocity, h1);
    return;
  }
  now.velocity = slope(first->holder.position, now.position, h1);
  const Sample* const second = before(2.0 * kBaseline);
  if (second == nullptr || second == first) return;
  const double h2 = first->time - second->time;
  const PlaneVector<double> earlier = slope(second->holder.position, first->holder.position, h2);
  now.acceleration = slope(earlier, now.velocity, 0.5 * (h1 + h2));
  now.velocity.x += 0.5 * h1 * now.acceleration.x;
  now.velocity.y += 0.5 * h1 * now.acceleration.y;
}

std::optional<Target> Follower::targetAt(double now, const PlaneVector<double>& here,
                                         double interval) {
  const bool alive = check_.isAlive(now);
  if (samples_.empty()) return std::nullopt;
  Target target = samples_.back().holder;
  if (!alive) return Target{target.position, {}, {}};
  const double age = now - samples_.back().time - interval;
  const auto move = [age](double& position, double& velocity, double acceleration) {
    position += age * (velocity + 0.5 * age * acceleration);
    velocity += age * acceleration;
  };
  move(target.position.x, target.velocity.x, target.acceleration.x);
  move(target.position.y, target.velocity.y, target.acceleration.y);
  const double distance = std::hypot(target.position.x - here.x, target.position.y - here.y);
  met_ = met_ || distance < kMet;
  if (!met_) approach(target, here, distance, now, interval);
  return target;
}

/// Lets the particle come to its holder with a limited speed relative to it.
void Follower::approach(Target& target, const PlaneVector<double>& here, double distance,
                        double now, double interval) {
  if (left_ == 0.0) {
    left_ = now;
    expected_ = now + 2.0 * distance / kApproachSpeed + 1.0;
    check_.say(fmt::format(": the particle comes to it from {:.3g} m away", distance));
  } else if (now > expected_) {
    expected_ = std::numeric_limits<double>::infinity();
    check_.say(fmt::format(" has not been met for {:.3g} s: the particle is {:.3g} m away",
                           now - left_, distance));
  }
  const double step = 2.0 * kApproachSpeed * std::max(interval, 1e-3);
  if (distance <= step) return;
  const double left = 1.0 - step / distance;
  target.position.x -= left * (target.position.x - here.x);
  target.position.y -= left * (target.position.y - here.y);
}

bool Follower::isSilent(double now) const {
  return samples_.empty() || now - samples_.back().time > kSilence;
}

void Follower::restart() {
  samples_.clear();
  met_ = false;
  left_ = 0.0;
  check_.restart();
}

struct HeldInputs::Held {
  explicit Held(HolderCheck check) : follower(std::move(check)) {}

  std::ptrdiff_t particle = 0;
  std::string frame;  ///< empty: topics
  Follower follower;
  double stamp = -1.0;  ///< s, of the last transform
  Throttle warnings;
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
          take(held, message->header, vectorOf(message->pose.position), std::nullopt);
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
                      const std::optional<geometry_msgs::Vector3>& velocity) {
  geometry_msgs::Vector3 place, speed;
  try {
    const auto transform = frames_.from(header.frame_id).transform;
    place = transformed(transform, position);
    if (velocity) speed = rotated(transform.rotation, velocity->x, velocity->y, velocity->z);
  } catch (const InputError& error) {
    if (held.warnings.isDue()) {
      ROS_WARN_STREAM("held_" << held.particle + 1 << ": " << error.what());
    }
    return;
  }
  const PlaneVector<double> at{place.x, place.z};
  const bool accepted = held.follower.take({at, {speed.x, speed.z}, {}}, velocity.has_value(),
                                           header.stamp.toSec(), wallTime());
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
    take(held, header, transformed(transform.transform, geometry_msgs::Point()), std::nullopt);
  } catch (const InputError& error) {
    if (held.follower.isSilent(now) && held.warnings.isDue()) {
      ROS_WARN_STREAM("held_" << held.particle + 1 << "_frame: " << error.what());
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

/// Adds the weight and the inertia of a held particle, as the sensor of a gripper would feel them. The mass of
/// P_1 is not used.
void HeldInputs::addWeight(std::ptrdiff_t particle, geometry_msgs::Vector3& force) const {
  const Chain& chain = run_.chain();
  PlaneVector<double> acceleration{};
  for (const HeldParticle& held : chain.drive().held) {
    if (held.particle == particle) acceleration = held.acceleration;
  }
  force.x -= chain.masses()[particle] * acceleration.x;
  force.z -= chain.masses()[particle] * (chain.gravity() + acceleration.y);
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
    if (i > 0) addWeight(i, message.wrench.force);
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
