// Scene that robots hold: input from topics or tf, output of the force on each holder.
#pragma once

#include "ros/inputs/driver.hpp"
#include "ros/inputs/follower.hpp"
#include "ros/inputs/frames.hpp"
#include "ros/messages/throttle.hpp"
#include "ros/parameters/node_options.hpp"

#include <geometry_msgs/Point.h>
#include <ros/node_handle.h>
#include <std_msgs/Header.h>

#include <cstddef>
#include <list>
#include <optional>
#include <string>
#include <vector>

namespace spring_pendulum {

/// Parses a list of particles "1, 5, last".
/// \returns their numbers, counted from 0
/// \throws InputError for a word that is no particle of the chain, or one given twice
std::vector<std::ptrdiff_t> parseParticleList(const std::string& text, std::ptrdiff_t particles,
                                              const std::string& key);

/// All particles held by robots (`~held`).
class Robots {
 public:
  /// \throws InputError for a list of particles that the chain does not have
  Robots(ros::NodeHandle& node, const Run& run, const NodeOptions& options, Driver& driver,
         Frames& frames);

  /// Reads tf and stops particles whose input is silent. Must be called before every state.
  /// \param real_time_factor simulated seconds per second; 0: unknown
  void follow(double real_time_factor);
  /// Publishes the forces on the holders and the transforms of `~tf_particles`.
  void show(const std_msgs::Header& header);
  /// Holds the particles where they are, after a reset.
  void reset();

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

  void connect(ros::NodeHandle& node, Robot& robot);
  void take(Robot& robot, const StampedTransform& transform, const geometry_msgs::Point& point,
            const std::optional<tf2::Vector3>& velocity, double now);
  void receive(Robot& robot, const std_msgs::Header& header, const geometry_msgs::Point& point,
               const std::optional<tf2::Vector3>& velocity);
  void lookUp(Robot& robot, double now);

  const Run& run_;
  Driver& driver_;
  Frames& frames_;
  std::list<Robot> robots_;  ///< at addresses that stay
  std::vector<std::ptrdiff_t> tf_particles_;
  ros::Publisher tf_;
};

}  // namespace spring_pendulum
