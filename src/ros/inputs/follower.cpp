#include "ros/inputs/follower.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

constexpr double kSilence = 0.5;        // s
constexpr double kApproachSpeed = 1.0;  // m/s, before a particle has met its holder
constexpr double kMet = 0.01;           // m
constexpr double kJitter = 0.1;         // s, largest believable delay of a message
constexpr double kHistory = 0.5;        // s, of inputs
constexpr double kBaseline = 0.03;  // s, least time between inputs whose difference is a velocity
constexpr double kJumpsPerSecond = 10.0;  // largest believable speed, in largest jumps per second

}  // namespace

InputCheck::Answer InputCheck::refuse(const std::string& why) {
  if (!said_) say(" " + why + ": the particle is held where it is");
  said_ = true;
  return Answer::kRefused;
}

bool InputCheck::follows(const Seen& before, const Seen& input) const {
  const double distance =
      std::hypot(input.position.x - before.position.x, input.position.y - before.position.y);
  return input.stamp >= before.stamp && distance <= longest_;
}

InputCheck::Answer InputCheck::check(const PlaneVector<double>& position,
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

bool InputCheck::isAlive(double now) {
  if (!last_ || now - last_->time < kSilence) return last_.has_value();
  if (!silent_ && !said_) say(" has stopped: the particle is held where it is");
  silent_ = true;
  return false;
}

bool Follower::take(const Target& input, bool has_velocity, double stamp, double now) {
  const InputCheck::Answer answer = check_.check(input.position, input.velocity, stamp, now);
  if (answer == InputCheck::Answer::kRefused) return false;
  if (answer == InputCheck::Answer::kReturns) {
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

}  // namespace spring_pendulum
