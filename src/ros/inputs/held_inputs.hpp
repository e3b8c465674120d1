// Particles that robots hold: input from topics or tf, output of the force on each holder.
#pragma once

#include "ros/inputs/frames.hpp"
#include "ros/inputs/holders.hpp"
#include "ros/parameters/node_options.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <ros/node_handle.h>

#include <cstddef>
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

/// Checks the positions of one holder and says once per episode what is wrong with them.
class HolderCheck {
 public:
  /// \param name    of the input, for messages
  /// \param longest largest believable jump, m
  HolderCheck(std::string name, double longest) : name_(std::move(name)), longest_(longest) {}

  /// Returns whether the particle may follow.
  /// \param stamp of the input, s; not compared with a clock
  bool accepts(const PlaneVector<double>& position, const PlaneVector<double>& velocity,
               double stamp, double now);
  /// Whether the last input came less than half a second ago.
  bool isAlive(double now);
  /// What is wrong, said once; empty if nothing new.
  std::string takeMessage() { return std::exchange(message_, {}); }
  /// Accepts the next input wherever and whenever it is.
  void restart() { last_.reset(); }

 private:
  bool refuse(const std::string& why);

  std::string name_;
  double longest_;
  std::optional<PlaneVector<double>> last_;
  double last_stamp_ = 0.0;
  double last_time_ = 0.0;  ///< s, wall clock
  bool said_ = false;
  bool silent_ = false;
  std::string message_;
};

/// Turns the inputs of one holder into targets of its particle.
class Follower {
 public:
  explicit Follower(HolderCheck check) : check_(std::move(check)) {}

  /// Takes an input that is believable.
  /// \param stamp of the input, s; not compared with a clock
  /// \param now   present time of a steady clock, s
  /// \returns whether it is
  bool take(const Target& input, double stamp, double now);
  /// Returns where the particle shall be; nothing before the first input.
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
  HolderCheck check_;
  std::optional<Target> input_;  ///< the last one
  double taken_ = 0.0;           ///< s, when it came
  bool met_ = false;             ///< whether the particle has reached its holder
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
            const geometry_msgs::Vector3& velocity);
  void lookUp(Held& held, double now);
  static void say(Held& held);

  const Run& run_;
  Holders& holders_;
  Frames& frames_;
  double y_;
  std::vector<std::unique_ptr<Held>> held_;
  std::vector<std::ptrdiff_t> tf_particles_;
  ros::Publisher tf_;
};

}  // namespace spring_pendulum
