#include "ros/inputs/robots.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

constexpr double kSilence = 0.5;        // s
constexpr double kApproachSpeed = 1.0;  // m/s, before a particle has met its holder
constexpr double kMet = 0.01;           // m
constexpr double kJitter = 0.1;         // s, largest believable delay of a message
constexpr double kLongestLead = 0.2;    // s, for which the motion of a holder is extrapolated
constexpr double kBaseline = 0.03;  // s, least time between inputs whose difference is a velocity
constexpr double kJumpsPerSecond = 10.0;  // largest believable speed, in largest jumps per second

}  // namespace

bool Follower::refuse(const std::string& why, double now) {
  refused_.reset();
  if (now < settled_at_) hold_until_ = now + kSilence;
  settled_at_ = now + kSilence;
  if (!std::exchange(warned_, true))
    warn_(name_ + " " + why + ": such inputs are ignored until they are steady");
  return false;
}

bool Follower::isNext(const Sample& before, const Sample& input) const {
  const PlaneVector<double>&from = before.holder.position, &to = input.holder.position;
  return input.stamp >= before.stamp && std::hypot(to.x - from.x, to.y - from.y) <= longest_;
}

bool Follower::isBelievable(const Sample& input) {
  const auto& [holder, stamp, now] = input;
  const auto& [position, velocity, acceleration] = holder;
  if (!std::isfinite(position.x + position.y + velocity.x + velocity.y))
    return refuse("has numbers that are not finite", now);
  const double fastest = kJumpsPerSecond * longest_;
  if (!(std::hypot(velocity.x, velocity.y) <= fastest))
    return refuse(fmt::format("moves at more than {:.3g} m/s", fastest), now);
  const bool is_next = samples_.empty() || isNext(samples_.back(), input);
  if (samples_.empty() || (is_next && now >= hold_until_)) return true;
  if (!refused_ || !isNext(*refused_, input)) steady_since_ = now;
  if (now - steady_since_ >= kSilence) {
    samples_.clear();
    settled_at_ = hold_until_ = now;
    return true;
  }
  const auto jump = fmt::format("jumps by more than {:.3g} m (check its frame and unit)", longest_);
  if (!is_next) refuse(stamp < samples_.back().stamp ? "runs backwards in time" : jump, now);
  refused_ = input;
  return false;
}

bool Follower::take(const Target& input, bool has_velocity, double stamp, double now) {
  Sample sample{input, stamp, now};
  if (!isBelievable(sample)) return false;
  if (now >= settled_at_ && std::exchange(warned_, false)) warn_(name_ + " is followed again");
  refused_.reset();
  if (samples_.empty() || isSilent(now)) {
    samples_.clear();
    met_ = false;
    left_ = 0.0;
  } else if (stamp > samples_.back().stamp) {
    // Differences of stamps have no jitter; but they may come from another clock.
    const double expected = samples_.back().time + (stamp - samples_.back().stamp);
    if (std::abs(now - expected) < kJitter) sample.time = std::min(now, expected);
  }
  samples_.push_back(sample);
  while (samples_.front().time < sample.time - kSilence) samples_.pop_front();
  estimateMotion(has_velocity);
  return true;
}

const Follower::Sample* Follower::before(double seconds) const {
  const Sample* found = nullptr;
  for (const Sample& sample : samples_)
    if (samples_.back().time - sample.time >= seconds) found = &sample;
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
  const PlaneVector<double> change = slope(earlier, now.velocity, 0.5 * (h1 + h2));
  // A step from rest is no acceleration that lasts.
  const double most = std::hypot(earlier.x, earlier.y) + kApproachSpeed;
  if (h1 * std::hypot(change.x, change.y) > most) return;
  now.acceleration = change;
  now.velocity.x += 0.5 * h1 * now.acceleration.x;
  now.velocity.y += 0.5 * h1 * now.acceleration.y;
}

std::optional<Target> Follower::targetAt(double now, const PlaneVector<double>& here,
                                         double interval) {
  if (samples_.empty()) return std::nullopt;
  Target target = samples_.back().holder;
  const double silence = now - samples_.back().time;
  if (silence > kLongestLead || now < hold_until_) {
    if (isSilent(now) && !std::exchange(warned_, true))
      warn_(name_ + " has stopped: the particle is held where it is");
    return Target{place_ ? *place_ : place_.emplace(here), {}, {}};
  }
  place_.reset();
  const double age = silence - interval;
  for (const auto axis : {&PlaneVector<double>::x, &PlaneVector<double>::y}) {
    target.position.*axis += age * (target.velocity.*axis + 0.5 * age * target.acceleration.*axis);
    target.velocity.*axis += age * target.acceleration.*axis;
  }
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
    warn_(name_ + fmt::format(": the particle comes to it from {:.3g} m away", distance));
  } else if (now > expected_) {
    expected_ = std::numeric_limits<double>::infinity();
    warn_(name_ + fmt::format(" has not been met for {:.3g} s: the particle is {:.3g} m away",
                              now - left_, distance));
  }
  const double share = std::min(1.0, 2.0 * kApproachSpeed * std::max(interval, 1e-3) / distance);
  target.position.x = here.x + share * (target.position.x - here.x);
  target.position.y = here.y + share * (target.position.y - here.y);
}

bool Follower::isSilent(double now) const {
  return samples_.empty() || now - samples_.back().time >= kSilence;
}

}  // namespace spring_pendulum
