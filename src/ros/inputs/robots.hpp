// Particles that robots hold: input from topics or tf, output of the force on each holder.
#pragma once

#include "ros/inputs/driver.hpp"
#include "ros/inputs/frames.hpp"
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

/// All particles held by robots (`~held`).
class Robots {
 public:
  /// \throws InputError for a list of particles that the chain does not have
  Robots(ros::NodeHandle& node, const Run& run, const NodeOptions& options, Driver& driver,
         Frames& frames);
  ~Robots();

  /// Reads tf and stops particles whose input is silent. Must be called before every state.
  /// \param real_time_factor simulated seconds per second; 0: unknown
  void follow(double real_time_factor);
  /// Publishes the forces on the holders and the transforms of `~tf_particles`.
  void show(const std_msgs::Header& header);
  /// Holds the particles where they are, after a reset.
  void reset();

 private:
  struct Robot;

  void take(Robot& robot, const std_msgs::Header& header, const geometry_msgs::Vector3& position,
            const std::optional<geometry_msgs::Vector3>& velocity);
  void lookUp(Robot& robot, double now);
  static void say(Robot& robot);
  void addWeight(std::ptrdiff_t particle, geometry_msgs::Vector3& force) const;

  const Run& run_;
  Driver& driver_;
  Frames& frames_;
  double y_;
  std::vector<std::unique_ptr<Robot>> robots_;
  std::vector<std::ptrdiff_t> tf_particles_;
  ros::Publisher tf_;
};

}  // namespace spring_pendulum
