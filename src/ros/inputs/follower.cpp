#include "ros/inputs/robots.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace spring_pendulum {

constexpr double kSilence = 0.5;        // s
constexpr double kApproachSpeed = 1.0;  // m/s, of a particle relative to its holder
constexpr double kMet = 0.01;           // m, within which a particle is with its holder
constexpr double kLost = 0.5;           // m, beyond which the log says that it is not
constexpr double kJitter = 0.03;        // s, largest delay of a message that is made good
constexpr double kCopied = 0.15;      // s, after which the same message says that its holder stands
constexpr double kAtOnce = 3.0;       // seconds of stamps per second in a bundle of inputs
constexpr double kSet = 0.1;          // s, least time by which a clock counts as set ahead
constexpr double kForget = 0.002;     // share of the delay, for each message, as clocks drift
constexpr double kLongestLead = 0.2;  // s, for which the motion of a holder is extrapolated
constexpr double kSteepest = 5.0;     // m/s², largest acceleration of a slow holder
constexpr double kBaseline = 0.06;    // s, least time between inputs whose difference is a velocity

bool Follower::refuse(const std::string& why, double now) {
  refused_at_ = now;
  if (!std::exchange(says_refused_, true))
    warn_(name_ + " " + why + ": such inputs are ignored until they are steady");
  return false;
}

double Follower::distance(const Sample& from, const Sample& to) {
  return std::hypot(to.holder.position.x - from.holder.position.x,
                    to.holder.position.y - from.holder.position.y);
}

bool Follower::isNext(const Sample& before, const Sample& input, double longest) {
  return input.stamp >= before.stamp && distance(before, input) <= longest;
}

bool Follower::isBelievable(const Sample& input) {
  const double now = input.time;
  if (!std::isfinite(input.holder.position.x + input.holder.position.y))
    return refuse("has numbers that are not finite", now);
  const auto refused = std::exchange(refused_, std::nullopt);
  if (isSilent(now) || isNext(samples_.back(), input, longest_)) return true;
  if (refused && isNext(*refused, input, longest_)) {
    if (distance(samples_.back(), input) > longest_) samples_.clear();
    return true;
  }
  refused_ = input;
  if (input.stamp < samples_.back().stamp) return refuse("runs backwards in time", now);
  return refuse(fmt::format("jumps by more than {:.3g} m (check its frame and unit)", longest_),
                now);
}

bool Follower::take(const PlaneVector<double>& position, double stamp, double now) {
  Sample sample{{position, {}, {}}, stamp, now, now};
  const bool is_copy = !isSilent(now) && stamp != 0.0 && stamp == samples_.back().stamp;
  if (is_copy && isNext(samples_.back(), sample, 0.0)) {
    if (now < samples_.back().arrival + kCopied) return true;
    samples_.clear();
  }
  if (!isBelievable(sample)) return false;
  if (now >= refused_at_ + kSilence && (says_refused_ || says_stopped_)) {
    says_refused_ = says_stopped_ = false;
    warn_(name_ + " is followed again");
  }
  if (!samples_.empty()) {
    const double step = stamp - samples_.back().stamp, gap = now - samples_.back().arrival;
    const double usual =
        samples_.size() > 1 ? samples_.back().stamp - samples_.rbegin()[1].stamp : 0.0;
    // The clock of the stamps has been set: back if an input was refused, so that one is missing, or ahead.
    if (step < 0.0 || step > gap + usual + kSet)
      for (Sample& earlier : samples_) earlier.stamp += step - (step < 0.0 ? gap : usual);
  }
  if (isSilent(now)) {
    samples_.clear();
    left_ = 0.0;
  } else if (const double step = stamp - samples_.back().stamp; step > 0.0) {
    // Differences of stamps have no jitter, but their clock may be slower.
    const double expected = samples_.back().time + step;
    sample.time = std::clamp(expected + kForget * (now - expected), now - kJitter, now);
  }
  // Inputs that come at once were late, all but the last: they are spread from the one before them on.
  const Sample* last = nullptr;
  for (Sample& earlier : samples_) {
    if (earlier.time < sample.time - kSilence ||
        stamp - earlier.stamp <= kAtOnce * (now - earlier.arrival)) {
      last = &earlier;
    } else if (last != nullptr) {
      const double share = (earlier.stamp - last->stamp) / (stamp - last->stamp);
      earlier.time = last->time + share * (sample.time - last->time);
    }
  }
  place_.reset();
  samples_.push_back(sample);
  while (samples_.front().time < sample.time - 2.0 * kSilence) samples_.pop_front();
  estimateMotion();
  return true;
}

const Follower::Sample* Follower::before(double seconds) const {
  const Sample* found = nullptr;
  for (const Sample& sample : samples_)
    if (samples_.back().time - sample.time >= seconds) found = &sample;
  return found;
}

// The parabola through three inputs. A step of the input is neither a velocity nor an acceleration that lasts.
void Follower::estimateMotion() {
  using Vector = PlaneVector<double>;
  Target& now = samples_.back().holder;
  const Sample* const first = before(kBaseline);
  if (first == nullptr) return;
  const auto slope = [](const Vector& from, const Vector& to, double time) {
    return Vector{(to.x - from.x) / time, (to.y - from.y) / time};
  };
  const double h1 = samples_.back().time - first->time;
  const auto is_step = [h1](const Vector& u, const Vector& v) {
    const double slower = std::min(std::hypot(u.x, u.y), std::hypot(v.x, v.y));
    return std::hypot(v.x - u.x, v.y - u.y) > slower + kSteepest * h1;
  };
  const Sample* const second = before(h1 + kBaseline);
  if (second == nullptr) return;
  now.velocity = slope(first->holder.position, now.position, h1);
  const double h2 = first->time - second->time;
  const Vector earlier = slope(second->holder.position, first->holder.position, h2);
  if (is_step(earlier, now.velocity)) {
    for (const Vector& other : {earlier, slope(second->holder.position, now.position, h1 + h2)})
      if (std::hypot(other.x, other.y) < std::hypot(now.velocity.x, now.velocity.y))
        now.velocity = other;
    return;
  }
  now.acceleration = slope(earlier, now.velocity, 0.5 * (h1 + h2));
  now.velocity.x += 0.5 * h1 * now.acceleration.x;
  now.velocity.y += 0.5 * h1 * now.acceleration.y;
}

std::optional<Target> Follower::targetAt(double now, const PlaneVector<double>& here,
                                         double interval) {
  if (samples_.empty()) return std::nullopt;
  Target target = samples_.back().holder;
  const double silence = now - samples_.back().time;
  if (silence > kLongestLead) {
    if (isSilent(now) && now >= refused_at_ + kSilence && !std::exchange(says_stopped_, true))
      warn_(name_ + " has stopped: the particle is held where it is");
    if (!place_) place_ = interval == 0.0 ? target.position : here;  // it is seen late in a pause
    return Target{*place_, {}, {}};
  }
  if (interval > kSilence) target.velocity = target.acceleration = {};  // unknown for so long
  const double age = silence - interval;
  for (const auto axis : {&PlaneVector<double>::x, &PlaneVector<double>::y}) {
    target.position.*axis += age * (target.velocity.*axis + 0.5 * age * target.acceleration.*axis);
    target.velocity.*axis += age * target.acceleration.*axis;
  }
  if (interval == 0.0) left_ = 0.0;  // paused: the particle is placed at its holder
  if (interval > 0.0) approach(target, here, now);
  return target;
}

/// Lets the particle come to its holder with a limited speed relative to it.
void Follower::approach(Target& target, const PlaneVector<double>& here, double now) {
  target.fastest = kApproachSpeed;
  const double distance = std::hypot(target.position.x - here.x, target.position.y - here.y);
  if (distance < kMet) left_ = 0.0;
  if (left_ == 0.0 && distance > kLost) {
    left_ = now;
    if (now > std::exchange(jumped_, now) + kSilence)  // two inputs in turn would fill the log
      warn_(name_ + fmt::format(": the particle comes to it from {:.3g} m away", distance));
    expected_ = now + 2.0 * distance / kApproachSpeed + 1.0;
  } else if (left_ != 0.0 && now > expected_) {
    expected_ = std::numeric_limits<double>::infinity();
    warn_(name_ + fmt::format(" has not been met for {:.3g} s: the particle is {:.3g} m away",
                              now - left_, distance));
  }
}

bool Follower::isSilent(double now) const {
  return samples_.empty() || now - samples_.back().time >= kSilence;
}

}  // namespace spring_pendulum
