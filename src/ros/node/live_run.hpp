// A run with its integrator, and all that acts on it while it runs.
#pragma once

#include "ros/inputs/answer.hpp"
#include "ros/inputs/commands.hpp"
#include "ros/inputs/handles.hpp"
#include "ros/inputs/held_inputs.hpp"
#include "ros/inputs/holders.hpp"
#include "ros/inputs/input_messages.hpp"
#include "ros/inputs/saved_states.hpp"
#include "ros/node/player.hpp"
#include "ros/node/publisher.hpp"

#include <memory>
#include <vector>

namespace spring_pendulum {

class LiveRun {
 public:
  /// All arguments must outlive this object.
  LiveRun(ros::NodeHandle& node, ros::NodeHandle& private_node, Run& run,
          std::unique_ptr<Integrator>& integrator, const NodeOptions& options, Player& player);

  void start();
  /// Takes one action of the player, with the changes that are wanted before it.
  void act(Player::Action action, const Publisher& publisher);
  /// Tells subscribers of the inputs that no more will come.
  void end() { log_.ended(run_); }
  bool isGrabbed() const { return handles_.isGrabbed(); }
  /// Moves the handles to the particles and publishes the forces on holders.
  void show(const std_msgs::Header& header);

 private:
  MenuActions menuActions();
  void change(double next_time, bool paused);

  Run& run_;
  std::unique_ptr<Integrator>& integrator_;
  Player& player_;
  std::vector<PendulumInput> sent_;  ///< for subscribers that come late
  std::size_t sent_bytes_ = 0;
  ros::Publisher inputs_;
  InputLog log_;
  Holders holders_;
  Throttle refusals_;
  Frames frames_;
  Handles handles_;
  HeldInputs held_inputs_;
  Commands commands_;
  SavedStates states_;
};

}  // namespace spring_pendulum
