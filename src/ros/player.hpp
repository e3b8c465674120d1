// Decides what a node does next: paces a run by the wall clock, or by another node's simulated
// time, and lets the services ~pause, ~step and ~reset interrupt it.
#pragma once

#include "ros/master_registration.hpp"
#include "ros/node_options.hpp"
#include "ros/pacer.hpp"
#include "ros/pendulum_run.hpp"
#include <spring_pendulum/PendulumState.h>

#include <ros/node_handle.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <string>

namespace spring_pendulum {

class Player {
 public:
  enum class Action {
    kAdvance,       ///< on to the next state shown
    kAdvanceFrame,  ///< on to the next frame
    kReset,         ///< back to frame 0
    kShowBetween,   ///< slow motion: show a state between the last two, see `shownShare`
    kShowAgain,     ///< nothing moves; show the same once more to who came late
    kQuit
  };

  /// \param run outlives the player
  Player(ros::NodeHandle& node, ros::NodeHandle& private_node, const PendulumRun& run,
         const NodeOptions& options, MasterRegistration& registration);

  /// Serves callbacks until something is due.
  Action next();

  bool isPaused() const { return paused_; }
  /// What to show: 1 for the state of the run, less for one between it and the state before. In
  /// slow motion a run is one state ahead of what is shown.
  double shownShare() const;
  /// How fast the run goes: "1.00 x real time"
  std::string pace() const;

 private:
  using TriggerRequest = std_srvs::Trigger::Request;
  using TriggerResponse = std_srvs::Trigger::Response;

  bool onPause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool onStep(TriggerRequest& request, TriggerResponse& response);
  bool onReset(TriggerRequest& request, TriggerResponse& response);
  void onLeaderState(const PendulumState::ConstPtr& state);

  std::string overMessage() const;
  Action reset();
  bool isDue() const;
  bool isSlow() const;
  bool isAhead() const;
  bool isAtExit() const;
  void serveUntilDue();

  const PendulumRun& run_;
  NodeOptions options_;
  Pacer pacer_;
  bool paused_ = false;
  bool reset_wanted_ = false;
  std::int64_t steps_wanted_ = 0;
  double ahead_from_ = -1.0;  ///< s, time of the state before the run's in slow motion, else < 0
  ros::SteadyTime next_between_;
  double leader_time_ = -1.0;     ///< s, simulated time of the node that is followed
  ros::SteadyTime stands_since_;  ///< zero while the run moves
  ros::SteadyTime last_shown_;    ///< while the run stands
  ros::ServiceServer pause_;
  ros::ServiceServer step_;
  ros::ServiceServer reset_;
  ros::Subscriber leader_;
};

}  // namespace spring_pendulum
