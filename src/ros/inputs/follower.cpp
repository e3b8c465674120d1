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
constexpr double kCopied = 0.15;  // s, after which the same message says that its holder stands
constexpr double kAtOnce = 3.0;   // seconds of stamps per second in a bundle of inputs
constexpr double kFastestClock = 20.0;  // the same, largest of a clock that is not known yet
constexpr double kForget = 0.002;       // share of the delay, for each message, as clocks drift
constexpr double kMemory = 4.0;  // s, for which inputs are kept; their clock is known after half
constexpr double kOtherClock = 0.1;   // share by which a clock that is no real time differs from it
constexpr double kLongestLead = 0.2;  // s, for which the motion of a holder is extrapolated
constexpr double kSteepest = 5.0;     // m/s², largest acceleration of a slow holder
constexpr double kBaseline = 0.03;    // s, least time between inputs whose difference is a velocity
constexpr double kJumpsPerSecond = 10.0;  // largest believable speed, in largest jumps per second

bool Follower::refuse(const std::string& why, double now) {
  refused_at_ = now;
  if (!std::exchange(says_refused_, true))
    warn_(name_ + " " + why + ": such inputs are ignored until they are steady");
  return false;
}

bool Follower::isNext(const Sample& before, const Sample& input, double longest) {
  const PlaneVector<double>&from = before.holder.position, &to = input.holder.position;
  return input.stamp >= before.stamp && std::hypot(to.x - from.x, to.y - from.y) <= longest;
}

bool Follower::isBelievable(const Sample& input) {
  const PlaneVector<double>&position = input.holder.position, &velocity = input.holder.velocity;
  const double now = input.time;
  if (!std::isfinite(position.x + position.y + velocity.x + velocity.y))
    return refuse("has numbers that are not finite", now);
  const double fastest = kJumpsPerSecond * longest_;
  if (!(std::hypot(velocity.x, velocity.y) <= fastest))
    return refuse(fmt::format("moves at more than {:.3g} m/s", fastest), now);
  const auto refused = std::exchange(refused_, std::nullopt);
  if (isSilent(now) || isNext(samples_.back(), input, longest_)) return true;
  if (refused && isNext(*refused, input, longest_)) {
    samples_.clear();
    return true;
  }
  refused_ = input;
  if (input.stamp < samples_.back().stamp) return refuse("runs backwards in time", now);
  return refuse(fmt::format("jumps by more than {:.3g} m (check its frame and unit)", longest_),
                now);
}

bool Follower::take(const Target& input, bool has_velocity, double stamp, double now) {
  Sample sample{input, input.velocity, stamp, now, now};
  const bool is_copy = !isSilent(now) && stamp != 0.0 && stamp == samples_.back().stamp;
  if (is_copy && isNext(samples_.back(), sample, 0.0)) {
    if (now < samples_.back().arrival + kCopied) return true;
    samples_.clear();
    sample.holder.velocity = {};
  }
  if (!isBelievable(sample)) return false;
  if (now >= refused_at_ + kSilence && (says_refused_ || says_stopped_)) {
    says_refused_ = says_stopped_ = false;
    warn_(name_ + " is followed again");
  }
  if (!samples_.empty()) {  // the clock of the stamps may have been set
    const Sample& back = samples_.back();
    const double step = stamp - back.stamp, known = back.stamp - samples_.front().stamp;
    const double usual = samples_.size() > 1 ? back.stamp - samples_.rbegin()[1].stamp : 0.0;
    const double rate = known > 0.0 ? samples_.front().rateTo(back) : kFastestClock;
    const double lost = 1.5 * rate * (now - back.arrival);
    const bool is_set = step - std::max(usual, lost) > kSilence;
    for (Sample& earlier : samples_) earlier.stamp += is_set ? step - usual : 0.0;
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
  while (samples_.front().time < sample.time - kMemory) samples_.pop_front();
  estimateMotion(has_velocity);
  return true;
}

const Follower::Sample* Follower::before(double seconds) const {
  const Sample* found = nullptr;
  for (const Sample& sample : samples_)
    if (samples_.back().time - sample.time >= seconds) found = &sample;
  return found;
}

// The rate of the clock of the stamps: of both halves of the inputs and the last ones, the rate nearest to 1.
// It is taken as 1 until it is known and if it is off by less than 5 %, in full from 15 % on.
double Follower::clockRate() const {
  const Sample &oldest = samples_.front(), &newest = samples_.back();
  const Sample *const recent = before(kSilence), &middle = samples_[samples_.size() / 2];
  if (recent == nullptr || newest.arrival <= oldest.arrival + 0.5 * kMemory) return 1.0;
  const double early = oldest.rateTo(middle), late = middle.rateTo(newest);
  const auto [slow, fast] = std::minmax({early, late, recent->rateTo(newest)});
  const double excess = std::max(slow - 1.0, 0.0) + std::min(fast - 1.0, 0.0);
  const double weight = std::clamp(std::abs(excess) / kOtherClock - 0.5, 0.0, 1.0);
  return std::min(early, late) > 0.0 ? 1.0 + weight * excess : 1.0;
}

// Poses: the parabola through three inputs. Odometry: the change of the velocity between two. A step of
// the input is neither a velocity nor an acceleration that lasts.
void Follower::estimateMotion(bool has_velocity) {
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
  if (has_velocity) {
    const double rate = clockRate();
    now.velocity = {rate * now.velocity.x, rate * now.velocity.y};
    const Vector earlier{rate * first->by_clock.x, rate * first->by_clock.y};
    if (!is_step(earlier, now.velocity)) now.acceleration = slope(earlier, now.velocity, h1);
    return;
  }
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
