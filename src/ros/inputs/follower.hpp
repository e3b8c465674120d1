// From the inputs of a robot that holds a particle to the targets of the particle.
#pragma once

#include "ros/inputs/requests.hpp"

#include <deque>
#include <optional>
#include <string>
#include <utility>

namespace spring_pendulum {

/// Validates the pose stream of one holder and logs each problem once.
class InputCheck {
 public:
  /// \param name    of the input, for messages
  /// \param longest largest believable jump, m
  InputCheck(std::string name, double longest) : name_(std::move(name)), longest_(longest) {}

  enum class Answer { kRefused, kFollows, kReturns };

  /// Returns whether the particle may follow an input, or first has to come to it again: the first input,
  /// and one after a silence. A lasting jump, or a clock that starts again, is believed once the input has
  /// been steady for half a second.
  /// \param stamp of the input, s; not compared with a clock
  Answer check(const PlaneVector<double>& position, const PlaneVector<double>& velocity,
               double stamp, double now);
  /// Whether the last input came less than half a second ago.
  bool isAlive(double now);
  void say(const std::string& what) { message_ = name_ + what; }
  /// What is wrong, said once; empty if nothing new.
  std::string takeMessage() { return std::exchange(message_, {}); }
  /// Accepts the next input wherever and whenever it is.
  void restart() { last_.reset(); }

 private:
  struct Seen {
    PlaneVector<double> position;  ///< m
    double stamp;                  ///< s
    double time;                   ///< s, steady clock
  };
  bool follows(const Seen& before, const Seen& input) const;
  Answer refuse(const std::string& why);

  std::string name_;
  double longest_;
  std::optional<Seen> last_;     ///< accepted
  std::optional<Seen> refused_;  ///< the last one, since the last accepted one
  double steady_since_ = 0.0;    ///< s, of the refused ones
  bool said_ = false;
  bool silent_ = false;
  std::string message_;
};

/// Turns the inputs of one holder into targets of its particle.
class Follower {
 public:
  explicit Follower(InputCheck check) : check_(std::move(check)) {}

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
  /// See InputCheck.
  std::string takeMessage() { return check_.takeMessage(); }
  /// Forgets the inputs, after a reset.
  void restart();

 private:
  struct Sample {
    Target holder;
    double stamp;  ///< s
    double time;   ///< s, steady clock
  };
  /// The last input that is at least this much older than the newest one; null: none.
  const Sample* before(double seconds) const;
  void estimateMotion(bool has_velocity);
  void approach(Target& target, const PlaneVector<double>& here, double distance, double now,
                double interval);

  InputCheck check_;
  std::deque<Sample> samples_;  ///< the newest last
  bool met_ = false;            ///< whether the particle has reached its holder
  double left_ = 0.0;           ///< s, when it began to come to its holder; 0: not yet
  double expected_ = 0.0;       ///< s, when it should have met it
};

}  // namespace spring_pendulum
