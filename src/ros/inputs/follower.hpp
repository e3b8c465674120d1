// From the inputs of a robot that holds a particle to the targets of the particle.
#pragma once

#include "ros/inputs/requests.hpp"

#include <deque>
#include <optional>
#include <string>
#include <utility>

namespace spring_pendulum {

/// Turns the inputs of one holder into targets of its particle, and says each problem once. The particle
/// follows an input that is believable. At the start, after a silence of half a second and after a
/// jump it first comes to its holder. A lasting jump, or a clock that starts again, is believed once the
/// input has been steady for half a second.
class Follower {
 public:
  /// \param name    of the input, for messages
  /// \param longest largest believable jump, m
  Follower(std::string name, double longest) : name_(std::move(name)), longest_(longest) {}

  /// Takes an input that is believable.
  /// \param has_velocity otherwise, the velocity follows from earlier inputs
  /// \param stamp        of the input, s; not compared with a clock
  /// \param now          present time of a steady clock, s
  /// \returns whether it is
  bool take(const Target& input, bool has_velocity, double stamp, double now);
  /// Returns where the particle shall be at the present state, so that it is with its holder in the next
  /// one, which is shown now; nothing before the first input.
  /// \param here     position of the particle, m
  /// \param interval until the next state, s
  std::optional<Target> targetAt(double now, const PlaneVector<double>& here, double interval);
  /// Whether no input came for half a second.
  bool isSilent(double now) const;
  /// What is new about the input; empty: nothing.
  std::string takeMessage() { return std::exchange(message_, {}); }
  /// Forgets the inputs, after a reset.
  void restart();

 private:
  struct Sample {
    Target holder;
    double stamp;  ///< s
    double time;   ///< s, steady clock
  };
  void say(const std::string& what) { message_ = name_ + what; }
  bool isNext(const Sample& before, const Sample& input) const;
  bool isBelievable(const Sample& input);
  bool refuse(const std::string& why);
  /// The last input that is at least this much older than the newest one; null: none.
  const Sample* before(double seconds) const;
  void estimateMotion(bool has_velocity);
  void approach(Target& target, const PlaneVector<double>& here, double distance, double now,
                double interval);

  std::string name_;
  double longest_;
  std::deque<Sample> samples_;     ///< since the particle began to come to its holder, newest last
  std::optional<Sample> refused_;  ///< the last one, since the last accepted one
  double steady_since_ = 0.0;      ///< s, of the refused ones
  bool said_ = false;              ///< that the input is refused, or silent
  std::string message_;
  bool met_ = false;       ///< whether the particle has reached its holder
  double left_ = 0.0;      ///< s, when it began to come to its holder; 0: not yet
  double expected_ = 0.0;  ///< s, when it should have met it
};

}  // namespace spring_pendulum
