// Particles that robots hold: input from topics or tf, output of the force on each holder.
#pragma once

#include "ros/inputs/frames.hpp"
#include "ros/inputs/holders.hpp"
#include "ros/parameters/node_options.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <ros/node_handle.h>

#include <cstddef>
#include <deque>
#include <memory>
#include <nav_msgs/Odometry.h>
#include <optional>
#include <string>
#include <vector>

namespace spring_pendulum {

/// Parses a list of particles "1, 5, last".
/// \returns their numbers, counted from 0
/// \throws InputError for a word that is no particle of the chain, or one given twice
std::vector<std::ptrdiff_t> parseParticleList(const std::string& text, std::ptrdiff_t particles,
                                              const std::string& key);

/// Validates the pose stream of one holder and logs each problem once.
class HolderCheck {
 public:
  /// \param name    of the input, for messages
  /// \param longest largest believable jump, m
  HolderCheck(std::string name, double longest) : name_(std::move(name)), longest_(longest) {}

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
  explicit Follower(HolderCheck check) : check_(std::move(check)) {}

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
  /// See HolderCheck.
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

  HolderCheck check_;
  std::deque<Sample> samples_;  ///< the newest last
  bool met_ = false;            ///< whether the particle has reached its holder
  double left_ = 0.0;           ///< s, when it began to come to its holder; 0: not yet
  double expected_ = 0.0;       ///< s, when it should have met it
};

/// All particles held by robots (`~held`).
class HeldInputs {
 public:
  /// \throws InputError for a list of particles that the chain does not have
  HeldInputs(ros::NodeHandle& node, const Run& run, const NodeOptions& options, Holders& holders,
             Frames& frames);
  ~HeldInputs();

  /// Reads tf and stops particles whose input is silent. Must be called before every state.
  void watch();
  /// Publishes the forces on the holders and the transforms of `~tf_particles`.
  void show(const std_msgs::Header& header);
  /// Holds the particles where they are, after a reset.
  void reset();

 private:
  struct Held;

  void take(Held& held, const std_msgs::Header& header, const geometry_msgs::Vector3& position,
            const std::optional<geometry_msgs::Vector3>& velocity);
  void lookUp(Held& held, double now);
  static void say(Held& held);
  void addWeight(std::ptrdiff_t particle, geometry_msgs::Vector3& force) const;

  const Run& run_;
  Holders& holders_;
  Frames& frames_;
  double y_;
  std::vector<std::unique_ptr<Held>> held_;
  std::vector<std::ptrdiff_t> tf_particles_;
  ros::Publisher tf_;
};

}  // namespace spring_pendulum
