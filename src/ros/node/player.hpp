// Decides the next action of a node: paces a run by the wall clock or by the simulated time of
// another node, and provides the services ~pause, ~step and ~reset.
#pragma once

#include "ros/node/pacer.hpp"
#include "ros/node/publisher.hpp"
#include "ros/parameters/node_options.hpp"
#include <spring_pendulum/PendulumState.h>
#include <spring_pendulum/simulation/run.hpp>

#include <ros/node_handle.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <optional>
#include <string>
#include <utility>

namespace spring_pendulum {

class Player {
 public:
  enum class Action {
    kAdvance,       ///< advance to the next shown state
    kAdvanceFrame,  ///< advance to the next frame
    kReset,         ///< go to a frame, see `takeWanted`
    kShowAgain,     ///< show the same state again, for late subscribers
    kQuit
  };

  /// \param run must outlive the player
  Player(ros::NodeHandle& node, ros::NodeHandle& private_node, const Run& run,
         const NodeOptions& options);

  /// Serves callbacks until the next action is due.
  Action next();

  /// Pauses or continues, takes a step, or goes back to frame 0, as the services do.
  std::string pause(bool paused);
  std::string step();
  std::string reset();
  /// Goes to the frame and state of particles at the next action, which is `kReset`.
  void goTo(Particles particles);
  /// Removes and returns these particles; nothing: the run goes back to frame 0.
  std::optional<Particles> takeWanted() { return std::exchange(wanted_, std::nullopt); }
  bool isPaused() const { return paused_; }
  /// Sets the real-time factor from now on.
  void setSpeed(double real_time_factor);
  /// Shows the present state again soon, because the user has changed it.
  void touch() { touched_ = true; }

  /// How to show the present state. Must be called once after every action.
  Showing showing();

 private:
  using TriggerRequest = std_srvs::Trigger::Request;
  using TriggerResponse = std_srvs::Trigger::Response;

  bool onPause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool onStep(TriggerRequest& request, TriggerResponse& response);
  bool onReset(TriggerRequest& request, TriggerResponse& response);
  void onLeaderState(const PendulumState::ConstPtr& state);

  std::string overMessage() const;
  std::string pace() const;
  Action goBack();
  bool isDue() const;
  bool isAtExit() const;
  void serveUntilDue();

  const Run& run_;
  NodeOptions options_;
  Pacer pacer_;
  bool paused_ = false;
  bool reset_wanted_ = false;
  std::optional<Particles> wanted_;
  bool touched_ = false;
  std::int64_t steps_wanted_ = 0;
  double leader_time_ = -1.0;     ///< s, simulated time of the followed node
  ros::SteadyTime stands_since_;  ///< zero while the run advances
  ros::SteadyTime last_shown_;    ///< while the run is paused
  ros::ServiceServer pause_;
  ros::ServiceServer step_;
  ros::ServiceServer reset_;
  ros::Subscriber leader_;
};

}  // namespace spring_pendulum
