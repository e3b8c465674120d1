// Particles that robots hold: input from topics or tf, output of the force on each holder.
#pragma once

#include "ros/inputs/driver.hpp"
#include "ros/inputs/frames.hpp"
#include "ros/messages/stamps.hpp"
#include "ros/parameters/node_options.hpp"

#include <geometry_msgs/Point.h>
#include <ros/node_handle.h>
#include <std_msgs/Header.h>

#include <cstddef>
#include <deque>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace spring_pendulum {

/// A particle, counted from 0, and the tf frame that it follows; empty: topics.
using HolderFrame = std::pair<std::ptrdiff_t, std::string>;

/// Parses the option `held`, "1, 5, last=gripper".
/// \throws InputError for a word that is no particle of the chain, or one given twice
std::vector<HolderFrame> parseHeld(const std::string& text, std::ptrdiff_t particles);

/// Turns the inputs of a holder into targets of its particle, which comes to it at a limited speed. Says each
/// problem once, and ignores unbelievable inputs until the next confirms a jump, or a clock that began again.
class Follower {
 public:
  /// \param name    of the input, for warnings
  /// \param longest largest believable jump, m
  /// \param warn    gets what is new about the input
  Follower(std::string name, double longest, std::function<void(const std::string&)> warn)
      : name_(std::move(name)), longest_(longest), warn_(std::move(warn)) {}

  /// Takes an input if it is believable, and returns whether it is.
  /// \param position of the holder, m
  /// \param stamp    of the input, s; its clock may show any time
  /// \param now      present time of a steady clock, s
  bool take(const PlaneVector<double>& position, double stamp, double now);
  /// Returns where the particle shall be at the present state, to be with its holder in the next one.
  /// \param here     position of the particle, m
  /// \param interval until the next state, s; 0: the particle is placed at its holder at once
  std::optional<Target> targetAt(double now, const PlaneVector<double>& here, double interval);
  bool isSilent(double now) const;  ///< whether no input came for half a second
  void restart() { *this = Follower(name_, longest_, warn_); }  ///< after a reset

 private:
  struct Sample {
    Target holder;
    double stamp;    ///< s
    double time;     ///< s, steady clock: when it was probably sent
    double arrival;  ///< s, steady clock
  };
  static double distance(const Sample& from, const Sample& to);  ///< m
  static bool isNext(const Sample& before, const Sample& input, double longest);
  bool isBelievable(const Sample& input);
  bool refuse(const std::string& why, double now);
  /// The last input that is at least this much older than the newest one; null: none.
  const Sample* before(double seconds) const;
  void estimateMotion();
  void approach(Target& target, const PlaneVector<double>& here, double now);

  std::string name_;
  double longest_;
  std::function<void(const std::string&)> warn_;
  std::deque<Sample> samples_;     ///< since the particle began to come to its holder, newest last
  std::optional<Sample> refused_;  ///< the last input, if it was a jump that was not taken
  double refused_at_ = 0.0;        ///< s, at the last refusal
  std::optional<PlaneVector<double>> place_;          ///< m, of a particle that waits for its input
  bool says_refused_ = false, says_stopped_ = false;  ///< of the input, since it was followed
  double left_ = 0.0;  ///< s, since when the particle has been far from its holder; 0: it is not
  double jumped_ = -1.0, expected_ = 0.0;  ///< s, when it got far, and should have come near again
};

/// All particles held by robots (`~held`).
class Robots {
 public:
  /// \throws InputError for a list of particles that the chain does not have
  Robots(ros::NodeHandle& node, const Run& run, const NodeOptions& options, Driver& driver,
         Frames& frames);

  void lookUp();  ///< reads tf; must be called often: a frame counts as received when it is read
  /// Moves the particles, and stops those whose input is silent. Must be called before every state.
  /// \param real_time_factor simulated seconds per second; 0: unknown
  /// \param next_time        of the next state, s; the present time while the run is paused
  void follow(double real_time_factor, double next_time);
  void show(const std_msgs::Header& header);  ///< publishes the forces on the holders
  void reset();                               ///< holds the particles where they are, after a reset

 private:
  struct Robot {
    std::ptrdiff_t particle;
    std::string name;   ///< "held_3"
    std::string frame;  ///< empty: topics
    Follower follower;
    double stamp = -1.0;  ///< s, of the last transform
    Throttle warnings{};
    bool warned = false;  ///< of a position out of the plane
    ros::Subscriber odometry{}, pose{};
    ros::Publisher wrench{};
  };

  static void take(Robot& robot, const StampedTransform& frame, const geometry_msgs::Point& point,
                   double now);
  void receive(Robot& robot, const std_msgs::Header& header, const geometry_msgs::Point& point);

  const Run& run_;
  Driver& driver_;
  Frames& frames_;
  std::list<Robot> robots_;  ///< at addresses that stay
};

}  // namespace spring_pendulum
